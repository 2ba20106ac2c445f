// SPDX-License-Identifier: MIT
// Rubbish in: one line that names the file, never a crash or a hang.
#include <gtest/gtest.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <BinTools.hxx>

#include <algorithm>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "io/cad/cad_fixtures.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/cad_reader.hpp"

namespace papilla::test {
namespace {

class CadErrors : public ::testing::Test {
 protected:
  /// The message of the refusal; empty when the file was read.
  std::string refusal(const std::string& name, const CadReadOptions& options = {}) {
    try {
      read_cad(folder_ / name, options);
      return {};
    } catch (const InvalidInput& error) {
      return error.what();
    }
  }
  /// One line that begins with the file's name.
  void expect_refused(const std::string& name) {
    const std::string message = refusal(name);
    EXPECT_TRUE(message.starts_with((folder_ / name).string() + ": ")) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  TemporaryFolder folder_;
};

TEST_F(CadErrors, PartFilesLieInTheFolderOfTheFileThatNamesThem) {
  namespace fs = std::filesystem;
  fs::create_directory(folder_ / "inside");
  CadFile file;
  const TDF_Label assembly = file.add_assembly("assembly");
  file.place(assembly, file.add("block", BRepPrimAPI_MakeBox(1, 2, 3).Shape()), gp_Trsf(), "one");
  file.write_step_with_part_files(folder_ / "inside/main.step");
  const std::string name = "inside/main.step", text = read_text(folder_ / name);
  const std::size_t source = text.find("EXTERNAL_SOURCE(IDENTIFIER('"), at = text.find('\'', source),
                    end = text.find('\'', at + 1);
  ASSERT_NE(source, std::string::npos) << "the file names no other one";
  const std::string part = text.substr(at + 1, end - at - 1);
  ASSERT_TRUE(fs::exists(folder_ / "inside" / part)) << part;
  EXPECT_EQ(read_cad(folder_ / name).parts.size(), 1U) << "a part file beside it is read";
  const auto with_name = [&](const std::string& other) {
    std::string changed = text;
    for (std::size_t i = 0; (i = changed.find("'" + part + "'", i)) != std::string::npos; i += other.size())
      changed.replace(i + 1, part.size(), other);
    folder_.write(name, changed);
  };
  fs::rename(folder_ / "inside" / part, folder_ / "outside.step");
  fs::create_symlink("../outside.step", folder_ / "inside/link.step");
  for (const std::string& other : {std::string("../outside.step"), (folder_ / "outside.step").string(),
                                   std::string("link.step"), std::string("/etc/passwd")}) {
    with_name(other);
    const std::string message = refusal(name);
    EXPECT_NE(message.find("main.step: external reference 1: '" + other + "' leads out"), std::string::npos) << message;
  }
  with_name("main.step");
  EXPECT_NE(refusal(name).find("names itself"), std::string::npos) << refusal(name);
}

TEST_F(CadErrors, MissingFileAndFolderAreIoErrors) {
  EXPECT_THROW(read_cad(folder_ / "missing.step"), IoError);
  EXPECT_THROW(read_cad(folder_ / "."), IoError);
}

TEST_F(CadErrors, EmptyAndForeignFilesAreRefused) {
  folder_.write("empty.step", "");
  folder_.write("text.step", "solid nothing\nendsolid\n");
  folder_.write("binary.brep", std::string("\0\1\2\3", 4));
  for (const char* name : {"empty.step", "text.step", "binary.brep"}) expect_refused(name);
}

TEST_F(CadErrors, StepWithoutEntitiesIsRefused) {
  folder_.write("none.step",
                "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
                "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n");
  expect_refused("none.step");
}

TEST_F(CadErrors, SyntaxErrorsOfStepNameTheLine) {
  write_step(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), folder_ / "box.step");
  const std::string text = read_text(folder_ / "box.step");
  const std::size_t data = text.find("DATA;");
  struct Damage {
    std::string what, with;
  };
  for (const auto& [what, with] :
       std::vector<Damage>{{"= PRODUCT(", " PRODUCT("}, {"(", "(("}, {");", ")"}, {"'", ""}}) {
    std::string damaged = text;
    damaged.replace(damaged.find(what, data), what.size(), with);
    folder_.write("damaged.step", damaged);
    expect_refused("damaged.step");
    EXPECT_NE(refusal("damaged.step").find("line "), std::string::npos);
  }
}

TEST_F(CadErrors, TruncatedFilesAreRefused) {
  const TopoDS_Shape shape = BRepPrimAPI_MakeCylinder(5, 20).Shape();
  write_step(shape, folder_ / "whole.step");
  write_iges(shape, folder_ / "whole.igs");
  write_brep(shape, folder_ / "whole.brep");
  for (const char* extension : {".step", ".igs", ".brep"}) {
    const std::string text = read_text(folder_ / (std::string("whole") + extension));
    for (const double part : {0.2, 0.5, 0.9}) {
      const std::string name = std::string("cut") + extension;
      folder_.write(name, text.substr(0, static_cast<std::size_t>(part * static_cast<double>(text.size()))));
      expect_refused(name);
    }
  }
}

TEST_F(CadErrors, TruncatedBrepsAreRefusedWhereverTheyEnd) {
  const TopoDS_Shape shape = BRepPrimAPI_MakeBox(1, 2, 3).Shape();
  std::ostringstream text, binary;
  BRepTools::Write(shape, text);
  BinTools::Write(shape, binary);
  // The text ends in a blank and "+1 0", the binary form in an orientation and two numbers: all that is cut from them
  // takes the whole shape away.
  for (const std::string& whole : {text.str(), binary.str()}) {
    const std::size_t least = std::string(whole).find_last_not_of(" \n");
    for (const std::size_t kept : {least, least - 1, least - 2, least - 8, least - 100, std::size_t{60}}) {
      folder_.write("cut.brep", whole.substr(0, kept));
      expect_refused("cut.brep");
    }
  }
}

/// Bytes changed at random: either a scene or a refusal in one line, whatever the library does with them.
class DamagedCadFile : public CadErrors, public ::testing::WithParamInterface<const char*> {};

TEST_P(DamagedCadFile, IsReadOrRefused) {
  const std::string extension = GetParam();
  const TopoDS_Shape shape = BRepPrimAPI_MakeCylinder(5, 20).Shape();
  if (extension == ".step") write_step(shape, folder_ / "whole.step");
  if (extension == ".igs") write_iges(shape, folder_ / "whole.igs");
  if (extension == ".brep") write_brep(shape, folder_ / "whole.brep");
  if (extension == ".brp") BinTools::Write(shape, (folder_ / "whole.brp").c_str());
  const std::string text = read_text(folder_ / ("whole" + extension));
  std::mt19937 random(7);
  for (int i = 0; i < 25; ++i) {
    std::string damaged = text;
    // The tail stays, or STEP and IGES would only count as truncated.
    for (int k = 0; k < 3; ++k) damaged[random() % (damaged.size() * 9 / 10)] = static_cast<char>('#' + random() % 24);
    const std::string name = "damaged" + extension;
    folder_.write(name, damaged);
    const std::string message = refusal(name);
    if (!message.empty()) expect_refused(name);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, DamagedCadFile, ::testing::Values(".step", ".igs", ".brep", ".brp"),
                         [](const auto& format) { return std::string(format.param).substr(1); });

TEST_F(CadErrors, OptionsOutOfRangeAreRefused) {
  write_brep(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), folder_ / "box.brep");
  const auto with = [](auto change) {
    CadReadOptions options;
    change(options);
    return options;
  };
  const std::vector<CadReadOptions> wrong = {with([](CadReadOptions& o) { o.chord_mm = 0; }),
                                             with([](CadReadOptions& o) { o.chord_mm = 1e-6; }),
                                             with([](CadReadOptions& o) { o.angle_deg = 91; }),
                                             with([](CadReadOptions& o) { o.angle_deg = 0; }),
                                             with([](CadReadOptions& o) { o.max_edge_mm = -1; }),
                                             with([](CadReadOptions& o) { o.max_edge_mm = 1e-4; }),
                                             with([](CadReadOptions& o) { o.millimetres_per_unit = 0; }),
                                             with([](CadReadOptions& o) { o.relative = true, o.chord_mm = 2; })};
  for (const CadReadOptions& options : wrong) EXPECT_FALSE(refusal("box.brep", options).empty());
}

TEST_F(CadErrors, ErrorsOfTheCallersProgressReachTheCaller) {
  write_brep(BRepPrimAPI_MakeTorus(20, 5).Shape(), folder_ / "torus.brep");
  struct Stop {};
  EXPECT_THROW(read_cad(folder_ / "torus.brep", {}, nullptr, [](const Progress&) -> bool { throw Stop(); }), Stop);
}

TEST_F(CadErrors, InThisProcessAndInAnotherGiveTheSame) {
  write_step(BRepPrimAPI_MakeTorus(20, 5).Shape(), folder_ / "torus.step");
  CadReadOptions here;
  here.isolated = false;
  CadReport report, report_here;
  const Scene other = read_cad(folder_ / "torus.step", {}, &report);
  const Scene own = read_cad(folder_ / "torus.step", here, &report_here);
  const TriangleMesh &a = other.parts.at(0).mesh, &b = own.parts.at(0).mesh;
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.normals.values, b.normals.values);
  EXPECT_EQ(a.cad_uv.indices, b.cad_uv.indices);
  EXPECT_EQ(other.extras_json, own.extras_json);
  EXPECT_EQ(other.nodes.at(0).extras_json, own.nodes.at(0).extras_json);
  EXPECT_EQ(report.triangles, report_here.triangles);
  EXPECT_EQ(report.max_deviation_mm, report_here.max_deviation_mm);
  // Threads of this process do not hinder a child afterwards.
  EXPECT_EQ(read_cad(folder_ / "torus.step").parts.at(0).mesh.triangles, a.triangles);
}

TEST_F(CadErrors, ProgressNeverFalls) {
  write_step(BRepPrimAPI_MakeTorus(20, 5).Shape(), folder_ / "torus.step");
  std::vector<double> fractions;
  read_cad(folder_ / "torus.step", {}, nullptr, [&](const Progress& done) {
    fractions.push_back(done.fraction);
    return true;
  });
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1);
  EXPECT_GT(fractions.size(), 4u);
}

TEST(CadExtensions, InAnyCase) {
  for (const char* name : {"a.STEP", "b.stp", "c.P21", "d.iges", "e.IGS", "f.brep", "g.brp"})
    EXPECT_TRUE(is_cad_extension(name)) << name;
  for (const char* name : {"a.stl", "step", "b.step.glb"}) EXPECT_FALSE(is_cad_extension(name)) << name;
}

}  // namespace
}  // namespace papilla::test
