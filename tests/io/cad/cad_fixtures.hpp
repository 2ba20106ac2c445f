// SPDX-License-Identifier: MIT
#pragma once

#include <TDF_Label.hxx>
#include <TDocStd_Document.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <filesystem>
#include <functional>
#include <gp_Pnt.hxx>
#include <gp_Trsf.hxx>
#include <string>

#include "papilla/io/scene.hpp"

class XCAFDimTolObjects_DimensionObject;

namespace papilla::test {

/// A document to be written as STEP.
class CadFile {
 public:
  CadFile();
  TDF_Label add(const std::string& name, const TopoDS_Shape& shape);
  TDF_Label add_assembly(const std::string& name);
  TDF_Label place(const TDF_Label& assembly, const TDF_Label& part, const gp_Trsf& where, const std::string& name);
  void colour(const TDF_Label& label, unsigned srgb, float alpha = 1);
  void colour_face(const TDF_Label& part, const TopoDS_Shape& face, unsigned srgb);
  void layer(const TDF_Label& label, const std::string& name);
  void material(const TDF_Label& label, const std::string& name, double density_g_per_cm3);
  /// A diameter with tolerances on a face of the part.
  void diameter(const TDF_Label& part, const TopoDS_Shape& face, double value, double upper, double lower);
  /// A flatness tolerance on a face of the part.
  void flatness(const TDF_Label& part, const TopoDS_Shape& face, double value);
  /// A diameter between two values.
  void range(const TDF_Label& part, const TopoDS_Shape& face, double low, double high);
  /// The distance between two faces of the part.
  void distance(const TDF_Label& part, const TopoDS_Shape& face, const TopoDS_Shape& other, double value);
  void validation(const TDF_Label& part, double area, double volume, const gp_Pnt& centroid);
  void write_step(const std::filesystem::path& path, const std::string& schema = "AP214IS",
                  const std::string& unit = "MM");

  /// Every part in a file of its own, which the one at `path` names; both lie in one folder.
  void write_step_with_part_files(const std::filesystem::path& path);

 private:
  void dimension(const TDF_Label& part, const TopoDS_Shape& face, const TopoDS_Shape& other,
                 const std::function<void(XCAFDimTolObjects_DimensionObject&)>& fill);

  Handle(TDocStd_Document) document_;
};

void write_step(const TopoDS_Shape& shape, const std::filesystem::path& path, const std::string& schema = "AP214IS");
void write_iges(const TopoDS_Shape& shape, const std::filesystem::path& path);
void write_brep(const TopoDS_Shape& shape, const std::filesystem::path& path);

TopoDS_Face face_of(const TopoDS_Shape& shape, int number);

/// The whole file as text, and back.
std::string read_text(const std::filesystem::path& path);

/// Enclosed volume by the divergence theorem; positive when wound outward.
double volume(const TriangleMesh& mesh);
/// Every edge is used once in each direction.
bool is_closed(const TriangleMesh& mesh);

}  // namespace papilla::test
