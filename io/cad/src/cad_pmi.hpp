// SPDX-License-Identifier: MIT
#pragma once

#include <TDocStd_Document.hxx>
#include <map>
#include <string>
#include <vector>

#include "cad_text.hpp"

namespace papilla::cad {

/// Product manufacturing information as text: dimensions, geometric tolerances and datums.
struct CadPmi {
  /// By entry of the part's label: {"kind", "type", "value", ..., "faces" as TriangleMesh::face numbers them}.
  std::map<std::string, Json> of_part;
  std::vector<std::string> losses;
};

CadPmi read_pmi(const Handle(TDocStd_Document) & document);

}  // namespace papilla::cad
