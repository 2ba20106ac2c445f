// SPDX-License-Identifier: MIT
#pragma once

#include <STEPCAFControl_Reader.hxx>
#include <TDocStd_Document.hxx>
#include <map>
#include <string>
#include <vector>

#include "cad_text.hpp"

namespace papilla::cad {

/// Data of a STEP file other than geometry that OpenCASCADE's document can't hold.
struct StepMetadata {
  Json header;                             ///< {"schema", "name", "time_stamp", "author", "organization", "system"}.
  std::map<std::string, Json> properties;  ///< By entry of the part's or instance's label: {name: value}.
  Json annotations;                        ///< Names of annotations that are only drawn, not meant.
};

/// @param reader after its transfer into the document.
StepMetadata read_step_metadata(STEPCAFControl_Reader& reader, const Handle(TDocStd_Document) & document);

/// Product manufacturing information as text: dimensions, geometric tolerances and datums.
struct CadPmi {
  /// By entry of the part's label: {"kind", "type", "value", ..., "faces" as TriangleMesh::face numbers them}.
  std::map<std::string, Json> of_part;
  std::vector<std::string> losses;
};

CadPmi read_pmi(const Handle(TDocStd_Document) & document);

}  // namespace papilla::cad
