// SPDX-License-Identifier: MIT
#include "papilla/io/assimp_reader.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "io/png_fixtures.hpp"
#include "io/scene_fixtures.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/scene_file.hpp"

namespace papilla {
namespace {

using test::message_of;
using test::TemporaryFolder;

/// A quad of two materials' halves, shown twice, in inches with z up: names, tree, uv, texture, polygon, losses.
std::string collada(const std::string& positions = "0 0 0 2 0 0 2 1 0 0 1 0", const std::string& picture = "wood.png") {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="inch" meter="0.0254"/><up_axis>Z_UP</up_axis></asset>
<library_cameras><camera id="c"><optics><technique_common><perspective><xfov>40</xfov><znear>1</znear><zfar>9</zfar>
</perspective></technique_common></optics></camera></library_cameras>
<library_images><image id="pic"><init_from>)" +
         picture + R"(</init_from></image></library_images>
<library_effects>
<effect id="e1"><profile_COMMON><newparam sid="s"><surface type="2D"><init_from>pic</init_from></surface></newparam>
<newparam sid="t"><sampler2D><source>s</source></sampler2D></newparam><technique sid="common"><lambert><diffuse>
<texture texture="t" texcoord="UV"/></diffuse></lambert></technique></profile_COMMON></effect>
<effect id="e2"><profile_COMMON><technique sid="common"><lambert><diffuse><color>0.25 0.5 0.75 1</color></diffuse>
</lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m1" name="Wood"><instance_effect url="#e1"/></material>
<material id="m2" name="Blue"><instance_effect url="#e2"/></material></library_materials>
<library_geometries><geometry id="g" name="panel"><mesh>
<source id="p"><float_array id="pa" count="12">)" +
         positions + R"(</float_array><technique_common><accessor source="#pa" count="4" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common>
</source><source id="u"><float_array id="ua" count="8">0 0 1 0 1 0.5 0 0.5</float_array><technique_common>
<accessor source="#ua" count="4" stride="2"><param name="S" type="float"/><param name="T" type="float"/></accessor>
</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1" material="a"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="TEXCOORD" source="#u" offset="1" set="0"/><vcount>4</vcount><p>0 0 1 1 2 2 3 3</p></polylist>
<triangles count="1" material="b"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1</p></triangles>
<lines count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2</p></lines>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="vs"><node id="cockpit" name="cockpit"><translate>1 2 3</translate>
<node id="n1" name="left"><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="a" target="#m1"/><instance_material symbol="b" target="#m2"/></technique_common>
</bind_material></instance_geometry></node>
<node id="n2" name="right"><translate>0 10 0</translate><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="a" target="#m1"/><instance_material symbol="b" target="#m2"/></technique_common>
</bind_material></instance_geometry></node><node id="n3" name="eye"><instance_camera url="#c"/></node></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#vs"/></scene></COLLADA>)";
}

std::string little_endian(std::size_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i, value >>= 8) text += static_cast<char>(value & 0xff);
  return text;
}

std::string deflated(const std::string& text) {
  std::string packed(text.size() + 100, '\0');
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

/// A ZIP archive of deflated files.
std::string zip(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string bytes, directory;
  for (const auto& [name, text] : files) {
    const std::string packed = deflated(text);
    const auto crc = ::crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(text.size()));
    const std::string common = little_endian(0x21000000, 4) + little_endian(crc, 4) + little_endian(packed.size(), 4) +
                               little_endian(text.size(), 4) + little_endian(name.size(), 2) + little_endian(0, 2);
    directory += "PK\1\2" + little_endian(20, 2) + little_endian(20, 2) + little_endian(0, 2) + little_endian(8, 2) +
                 common + little_endian(0, 10) + little_endian(bytes.size(), 4) + name;
    bytes += "PK\3\4" + little_endian(20, 2) + little_endian(0, 2) + little_endian(8, 2) + common + name + packed;
  }
  return bytes + directory + "PK\5\6" + little_endian(0, 4) + little_endian(files.size(), 2) +
         little_endian(files.size(), 2) + little_endian(directory.size(), 4) + little_endian(bytes.size(), 4) +
         little_endian(0, 2);
}

std::string package(const std::string& unit) {
  const std::string model = R"(<?xml version="1.0"?><model unit=")" + unit +
                            R"(" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>
<basematerials id="1"><base name="red" displaycolor="#FF000080"/></basematerials>
<object id="2" name="plate" pid="1" pindex="0" type="model"><mesh><vertices><vertex x="0" y="0" z="0"/>
<vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/></vertices><triangles><triangle v1="0" v2="1" v3="2" pid="1" p1="0"/>
</triangles></mesh></object><object id="3" type="model"><components>
<component objectid="2" transform="1 0 0 0 1 0 0 0 1 5 6 7"/></components></object></resources>
<build><item objectid="3" transform="0 1 0 -1 0 0 0 0 1 10 0 0"/></build></model>)";
  return zip(
      {{"_rels/.rels",
        R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>)"},
       {"3D/3dmodel.model", model}});
}

/// ASCII FBX in inches, z up: a quad below a node with a rotation pivot.
std::string fbx(const std::string& unit = "2.54") {
  return R"(; FBX 7.3.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7300
}
GlobalSettings:  {
	Version: 1000
	Properties70:  {
		P: "UpAxis", "int", "Integer", "",2
		P: "UpAxisSign", "int", "Integer", "",1
		P: "UnitScaleFactor", "double", "Number", "",)" +
         unit + R"(
	}
}
Objects:  {
	Geometry: 10, "Geometry::panel", "Mesh" {
		Vertices: *12 {
			a: 0,0,0,1,0,0,1,1,0,0,1,0
		}
		PolygonVertexIndex: *4 {
			a: 0,1,2,-4
		}
		GeometryVersion: 124
		LayerElementUV: 0 {
			Version: 101
			Name: "map"
			MappingInformationType: "ByPolygonVertex"
			ReferenceInformationType: "IndexToDirect"
			UV: *8 {
				a: 0,0,1,0,1,1,0,1
			}
			UVIndex: *4 {
				a: 0,1,2,3
			}
		}
		LayerElementUV: 1 {
			Version: 101
			Name: "other"
			MappingInformationType: "ByPolygonVertex"
			ReferenceInformationType: "IndexToDirect"
			UV: *8 {
				a: 0.5,0.5,0.75,0.5,0.75,0.625,0.5,0.625
			}
			UVIndex: *4 {
				a: 0,1,2,3
			}
		}
		LayerElementMaterial: 0 {
			Version: 101
			Name: ""
			MappingInformationType: "AllSame"
			ReferenceInformationType: "IndexToDirect"
			Materials: *1 {
				a: 0
			}
		}
		Layer: 0 {
			Version: 100
			LayerElement:  {
				Type: "LayerElementMaterial"
				TypedIndex: 0
			}
			LayerElement:  {
				Type: "LayerElementUV"
				TypedIndex: 0
			}
		}
		Layer: 1 {
			Version: 100
			LayerElement:  {
				Type: "LayerElementUV"
				TypedIndex: 1
			}
		}
	}
	Model: 20, "Model::seat", "Mesh" {
		Version: 232
		Properties70:  {
			P: "RotationPivot", "Vector3D", "Vector", "",1,0,0
			P: "Lcl Translation", "Lcl Translation", "", "A",10,4,-3
			P: "Lcl Rotation", "Lcl Rotation", "", "A",0,0,90
		}
	}
	Material: 30, "Material::leather", "" {
		Version: 102
		ShadingModel: "phong"
		Properties70:  {
			P: "DiffuseColor", "Color", "", "A",0.5,0.25,0.125
		}
	}
}
Connections:  {
	C: "OO",20,0
	C: "OO",10,20
	C: "OO",30,20
}
)";
}

std::string png() {
  const EncodedImage image = test::small_png("");
  return {reinterpret_cast<const char*>(image.bytes.data()), image.bytes.size()};
}

class AssimpReader : public testing::Test {
 protected:
  Scene read(const std::string& name, const std::string& bytes, const ReadOptions& options = {}) const {
    return read_scene(folder_.write(name, bytes), options);
  }
  std::string refusal(const std::string& name, const std::string& bytes) const {
    return message_of<InvalidInput>([&] { read(name, bytes); });
  }
  static bool names(const std::vector<std::string>& lines, const std::string& what) {
    return std::any_of(lines.begin(), lines.end(),
                       [&](const std::string& line) { return line.find(what) != std::string::npos; });
  }
  /// Corner 0 of an instance's first triangle, in its place.
  static Vec3 first_corner(const Scene& scene, std::size_t instance) {
    const Instance at = instances(scene).at(instance);
    return transform_point(at.world, scene.parts[at.part].mesh.corner(0, 0));
  }
  const TemporaryFolder folder_;
};

TEST_F(AssimpReader, ColladaKeepsTreeUnitAxisMaterialsAndTexture) {
  folder_.write("wood.png", png());
  const Scene scene = read("a.dae", collada());
  EXPECT_EQ(scene.format, "COLLADA");
  EXPECT_EQ(scene.unit, "in");
  EXPECT_EQ(scene.millimetres_per_unit, 25.4);
  EXPECT_EQ(scene.up, UpAxis::z);
  ASSERT_EQ(scene.parts.size(), 1U) << "both nodes show one part";
  ASSERT_EQ(scene.roots.size(), 1U);
  EXPECT_EQ(scene.nodes[scene.roots[0]].name, "cockpit");
  EXPECT_EQ(scene.parts[0].name, "panel");
  EXPECT_EQ(scene.parts[0].id, "cockpit/left");
  const TriangleMesh& mesh = scene.parts[0].mesh;
  ASSERT_EQ(mesh.triangles.size(), 3U);
  EXPECT_EQ(mesh.positions.size(), 4U) << "merged over materials";
  EXPECT_NEAR(norm(mesh.corner(0, 1) - mesh.corner(0, 0)), 50.8, 1e-5);
  EXPECT_NEAR(norm(first_corner(scene, 0) - 25.4 * Vec3{1, 2, 3}), 0, 1e-4);
  EXPECT_NEAR(norm(first_corner(scene, 1) - 25.4 * Vec3{1, 12, 3}), 0, 1e-4);
  ASSERT_EQ(scene.parts[0].materials.size(), 2U);
  const Material& wood = scene.materials[scene.parts[0].materials[0]];
  const Material& blue = scene.materials[scene.parts[0].materials[1]];
  EXPECT_EQ(wood.name, "Wood");
  EXPECT_EQ(blue.name, "Blue");
  EXPECT_EQ(blue.base_color, (std::array<double, 4>{0.25, 0.5, 0.75, 1}));
  ASSERT_TRUE(wood.base_color_texture);
  EXPECT_EQ(scene.images.at(*scene.textures.at(wood.base_color_texture->texture).image).uri, "wood.png");
  EXPECT_EQ(mesh.uv.values[mesh.uv.indices[0][2]], (Vec2{1, 0.5})) << "v runs up";
  EXPECT_FALSE(mesh.uv.has_value(2)) << "the second material's triangle has none";
  EXPECT_TRUE(names(scene.losses, "1 lines"));
  EXPECT_TRUE(names(scene.losses, "1 cameras"));
  EXPECT_EQ(scene.losses.size(), 2U);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(AssimpReader, UnitAndAxisCanBeOverridden) {
  ReadOptions options;
  options.millimetres_per_unit = 1;
  options.up = UpAxis::y;
  const Scene scene = read("a.dae", collada(), options);
  EXPECT_EQ(scene.unit, "mm");
  EXPECT_EQ(scene.up, UpAxis::y);
  EXPECT_NEAR(norm(first_corner(scene, 1) - Vec3{1, 12, 3}), 0, 1e-6);
}

TEST_F(AssimpReader, PicturesOutsideAreRefusedMissingOnesAreAWarning) {
  EXPECT_TRUE(names(read("a.dae", collada()).warnings, "texture 'wood.png' is missing"));
  const std::string out = refusal("a.dae", collada("0 0 0 2 0 0 2 1 0 0 1 0", "../secret.png"));
  EXPECT_NE(out.find("a.dae: material 'Wood'"), std::string::npos) << out;
  EXPECT_NE(out.find("../secret.png"), std::string::npos) << out;
  folder_.write("secret.png", png());
  EXPECT_EQ(read("a.dae", collada("0 0 0 2 0 0 2 1 0 0 1 0", "../secret.png")).images.size(), 1U) << "beside the file";
}

TEST_F(AssimpReader, ThreeMfHasItsUnitAndTransforms) {
  const Scene scene = read("a.3mf", package("inch"));
  EXPECT_EQ(scene.unit, "in");
  EXPECT_EQ(scene.up, UpAxis::z);
  ASSERT_EQ(scene.parts.size(), 1U);
  EXPECT_NEAR(norm(first_corner(scene, 0) - 25.4 * Vec3{10 - 6, 5, 7}), 0, 1e-4)
      << "5 6 7, turned a quarter about z, and 10 0 0";
  const Material& red = scene.materials.at(scene.parts[0].materials.at(0));
  EXPECT_EQ(red.base_color[0], 1);
  EXPECT_TRUE(names(scene.losses, "1 triangles with a material of their own"));
  EXPECT_TRUE(names(scene.losses, "1 names of objects"));
  EXPECT_EQ(read("a.3mf", package("micron")).millimetres_per_unit, 1e-3);
  EXPECT_NE(refusal("a.3mf", package("cubit")).find("the unit 'cubit'"), std::string::npos);
}

TEST_F(AssimpReader, FbxHasItsUnitAxisAndPivots) {
  const Scene scene = read("a.fbx", fbx());
  EXPECT_EQ(scene.unit, "in");
  EXPECT_EQ(scene.up, UpAxis::z);
  ASSERT_EQ(scene.nodes.size(), 1U) << "pivots are no nodes";
  EXPECT_EQ(scene.nodes[0].name, "seat");
  EXPECT_EQ(scene.parts.at(0).mesh.triangles.size(), 2U);
  EXPECT_EQ(scene.parts[0].mesh.positions.size(), 4U);
  EXPECT_EQ(scene.parts[0].mesh.uv.values[scene.parts[0].mesh.uv.indices[0][1]], (Vec2{1, 0}));
  EXPECT_NEAR(norm(first_corner(scene, 0) - 25.4 * Vec3{11, 3, -3}), 0, 1e-4)
      << "0 0 0, turned a quarter about z around 1 0 0, and moved by 10 4 -3";
  EXPECT_EQ(scene.parts[0].mesh.uv1.values[scene.parts[0].mesh.uv1.indices[0][1]], (Vec2{0.75, 0.5}));
  EXPECT_EQ(scene.materials.at(0).name, "leather");
  EXPECT_EQ(scene.materials[0].base_color, (std::array<double, 4>{0.5, 0.25, 0.125, 1}));
  EXPECT_NE(refusal("a.fbx", fbx("0")), "");
  EXPECT_NE(refusal("a.fbx", fbx("-1")), "");
}

TEST_F(AssimpReader, AcHasNoUnitAndX3dIsInMetres) {
  const Scene ac =
      read("chair.ac",
           "AC3Db\nMATERIAL \"cloth\" rgb 0.5 0.25 1  amb 0 0 0  emis 0 0 0  spec 0 0 0  shi 0  trans 0.5\n"
           "OBJECT world\nkids 1\nOBJECT group\nname \"base\"\nloc 0 50 0\nkids 1\nOBJECT poly\nname \"pad\"\n"
           "numvert 4\n0 0 0\n100 0 0\n100 0 100\n0 0 100\nnumsurf 1\nSURF 0x20\nmat 0\nrefs 4\n0 0 0\n3 0 1\n"
           "2 1 1\n1 1 0\nkids 0\n");
  EXPECT_EQ(ac.unit, "mm (assumed)");
  EXPECT_EQ(ac.up, UpAxis::y);
  EXPECT_EQ(ac.parts.at(0).id, "base/pad");
  EXPECT_EQ(ac.parts[0].mesh.triangles.size(), 2U);
  EXPECT_NEAR(norm(first_corner(ac, 0) - Vec3{0, 50, 0}), 0, 1e-6);
  EXPECT_EQ(ac.materials.at(0).base_color, (std::array<double, 4>{0.5, 0.25, 1, 0.5}));
  EXPECT_TRUE(names(ac.warnings, "states no unit")) << "a chair of 10 cm";

  folder_.write("a.png", png());
  const Scene x3d = read("a.x3d", R"x(<X3D version='3.0'><Scene><Transform DEF='dash' translation='1 2 3'><Shape>
<Appearance><Material diffuseColor='1 0.5 0'/><ImageTexture url='"a.png"'/></Appearance>
<IndexedFaceSet coordIndex='0 1 2 3 -1'><Coordinate point='0 0 0 1 0 0 1 1 0 0 1 0'/>
<TextureCoordinate point='0 0 1 0 1 1 0 1'/></IndexedFaceSet></Shape></Transform><Inline url='"other.x3d"'/>
</Scene></X3D>)x");
  EXPECT_EQ(x3d.unit, "m");
  EXPECT_EQ(x3d.up, UpAxis::y);
  EXPECT_EQ(x3d.nodes.at(x3d.roots.at(0)).name, "dash");
  EXPECT_NEAR(norm(first_corner(x3d, 0) - Vec3{1000, 2000, 3000}), 0, 1e-3);
  ASSERT_TRUE(x3d.materials.at(0).base_color_texture);
  EXPECT_EQ(x3d.images.at(0).uri, "a.png");
  EXPECT_TRUE(names(x3d.losses, "1 files that it includes"));
}

TEST_F(AssimpReader, DamagedFilesAreOneErrorOfOneLine) {
  const std::string rubbish = "\x7f\x01 rubbish \n<a><b>\n";
  for (const char* extension : {".fbx", ".3mf", ".dae", ".ac", ".x3d", ".blend"})
    for (const std::string& bytes : {std::string(), rubbish, std::string(5000, '('), std::string("PK\3\4")}) {
      const std::string text = refusal("bad" + std::string(extension), bytes);
      EXPECT_NE(text.find("bad" + std::string(extension) + ": "), std::string::npos) << extension << ": " << text;
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    }
  EXPECT_NE(refusal("a.dae", collada("0 0 0 2 0 nan 2 1 0 0 1 0")), "");
  EXPECT_NE(refusal("a.dae", collada("0 0 0 2 0 1e39 2 1 0 0 1 0")).find("not finite"), std::string::npos);
  for (const auto& [name, bytes] :
       {std::pair<std::string, std::string>{"t.dae", collada()}, {"t.3mf", package("inch")}, {"t.fbx", fbx()}})
    EXPECT_NE(refusal(name, bytes.substr(0, bytes.size() / 2)), "") << name;
}

TEST_F(AssimpReader, DeepTreesAreRefused) {
  std::string nodes, ends;
  for (int i = 0; i < 1100; ++i) nodes += "<Transform>", ends += "</Transform>";
  EXPECT_NE(refusal("deep.x3d", "<X3D version='3.0'><Scene>" + nodes +
                                    "<Shape><IndexedFaceSet coordIndex='0 1 2 -1'><Coordinate point='0 0 0 1 0 0 0 1 "
                                    "0'/></IndexedFaceSet></Shape>" +
                                    ends + "</Scene></X3D>"),
            "");
}

}  // namespace
}  // namespace papilla
