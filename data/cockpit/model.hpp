// SPDX-License-Identifier: MIT
#pragma once

#include <TDF_Label.hxx>
#include <TDocStd_Document.hxx>
#include <TopoDS_Shape.hxx>
#include <filesystem>
#include <gp_Trsf.hxx>
#include <string>

namespace cockpit {

/// An assembly with names and colours, written as STEP.
class Model {
 public:
  Model();

  /// @param srgb 0xRRGGBB.
  TDF_Label add_part(const std::string& name, const TopoDS_Shape& shape, unsigned srgb, double alpha = 1);
  TDF_Label add_assembly(const std::string& name);
  /// Uses a part or assembly in an assembly.
  void place(const TDF_Label& assembly, const TDF_Label& what, const gp_Trsf& where, const std::string& name);

  /// AP214, with a fixed time in the header: the same model gives the same bytes.
  void write(const std::filesystem::path& path);

 private:
  Handle(TDocStd_Document) document_;
};

}  // namespace cockpit
