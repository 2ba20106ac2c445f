// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/haptic/channel_field.hpp"
#include "papilla/haptic/contact_mesh.hpp"
#include "papilla/haptic/height_field.hpp"

namespace papilla {

/// @throws InvalidInput as ContactSurface's constructor does for arguments that do not fit each other.
void check_contact_input(const ContactMesh& mesh, const std::vector<ContactMaterial>& materials,
                         const std::vector<HeightField>& heights, const std::vector<ChannelField>& channels,
                         double radius);

}  // namespace papilla
