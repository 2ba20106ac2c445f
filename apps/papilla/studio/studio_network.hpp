// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "http/admission.hpp"
#include "studio/tls_files.hpp"

namespace papilla::app {

/// The names of the certificate and this machine's own by https; without one this machine's own by http.
ServedNames served_names(const std::optional<TlsFiles>& tls);

/// What pages under these names may ask beside their own server, as page_policy() has it: the socket under each name.
std::string socket_sources(const ServedNames& names, int port);

}  // namespace papilla::app
