// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "papilla/io/cad_reader.hpp"
#include "papilla/io/plugin.hpp"

namespace papilla::cad {

/// read_cad(), with the library in this very process or in one forked from it.
Scene read_file(const std::filesystem::path& path, const CadReadOptions& options, CadReport* report,
                const ProgressCallback& progress);

/// The BREP text of write_sample_solids().
std::string sample_solids_text();

/// What papilla_cad.so exports: all that links OpenCASCADE.
struct Plugin {
  PluginHeader header;
  decltype(&read_file) read;
  decltype(&sample_solids_text) sample_solids;
};

}  // namespace papilla::cad
