// SPDX-License-Identifier: MIT
// What OpenCASCADE alone takes to read a STEP file into a document and to mesh its shapes with all cores.
// usage: papilla-occt-mesh FILE.step CHORD_MM ANGLE_DEG; prints the number of triangles.
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  STEPCAFControl_Reader reader;
  reader.SetColorMode(true), reader.SetNameMode(true), reader.SetLayerMode(true), reader.SetMatMode(true);
  if (reader.ReadFile(argv[1]) != IFSelect_RetDone || !reader.Transfer(document)) return 3;
  TDF_LabelSequence shapes;
  const Handle(XCAFDoc_ShapeTool) tool = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  tool->GetShapes(shapes);
  long triangles = 0;
  constexpr double k_degree = 3.14159265358979323846 / 180;
  for (const TDF_Label& label : shapes) {
    if (XCAFDoc_ShapeTool::IsAssembly(label) || XCAFDoc_ShapeTool::IsReference(label)) continue;
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label);
    const BRepMesh_IncrementalMesh mesher(shape, std::atof(argv[2]), false, std::atof(argv[3]) * k_degree, true);
    for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) {
      TopLoc_Location place;
      const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(TopoDS::Face(face.Current()), place);
      if (!mesh.IsNull()) triangles += mesh->NbTriangles();
    }
  }
  std::printf("%ld\n", triangles);
  return 0;
}
