// SPDX-License-Identifier: MIT
#pragma once

#include <TDocStd_Document.hxx>
#include <filesystem>
#include <string>

#include "cad_metadata.hpp"
#include "papilla/core/progress.hpp"

namespace papilla::cad {

/// A CAD file as OpenCASCADE's document, in millimetres.
struct CadDocument {
  Handle(TDocStd_Document) document;
  std::string format;                 ///< "STEP", "IGES", "BREP".
  std::string unit = "mm (assumed)";  ///< The file's own, when it states one.
  double millimetres_per_unit = 1;
  StepMetadata metadata;
};

/// Reads the file into a document with assembly tree, names, colours, layers and materials.
/// @throws IoError, InvalidInput as read_cad(); Standard_Failure from inside the library.
CadDocument read_document(const std::filesystem::path& path, const ProgressCallback& progress);

}  // namespace papilla::cad
