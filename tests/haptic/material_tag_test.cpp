// SPDX-License-Identifier: MIT
#include "papilla/haptic/material_tag.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "papilla/core/error.hpp"
#include "papilla/texture/height_map.hpp"

namespace papilla {
namespace {

bool has(const std::vector<HapticWarning>& warnings, const std::string& code) {
  return std::any_of(warnings.begin(), warnings.end(), [&](const HapticWarning& w) { return w.code == code; });
}

MaterialTag full_tag() {
  MaterialTag tag;
  tag.stiffness = 900.1;
  tag.damping = 0.4;
  tag.static_friction = 0.45;
  tag.dynamic_friction = 0.35;
  tag.stribeck_velocity = 0.02;
  HeightTag height;
  height.uri = "grain \xC3\xA4.png";
  height.image = "haptic.height.grain";
  height.sha256 = std::string(64, 'a');
  height.size = {640, 480};
  height.scale_m = 2.0e-4 / 3;
  height.offset_m = -1.0e-4;
  height.white_is_outward = false;
  height.tex_coord = 1;
  height.uv_transform = {{0.1, 0.2}, 0.3, {2, 3}};
  height.metres_per_uv = {0.5, 0.25};
  height.wrap = {Wrap::mirror, Wrap::clamp};
  height.rms_m = 2.1e-5;
  tag.height = height;
  tag.roughness = RoughnessTag{2.31, 2.1e-5, {2e-4, 2e-2}};
  tag.symmetry = SymmetryTag{"pmm", {Vec2{0.012, 0}, Vec2{0, 0.012}}};
  tag.provenance = ProvenanceTag{"papilla 0.1.0", "shape-from-shading", "variational"};
  return tag;
}

TEST(HeightTag, IsTheMapInMetres) {
  const HeightMap relief{20, 10, Values<float>(200), 0.5, 0.25, true};
  const std::byte png[] = {std::byte{'a'}, std::byte{'b'}, std::byte{'c'}};
  EncodedRelief encoded{.png = png, .scale_mm = 0.5, .offset_mm = -0.25, .rms_mm = 0.125};
  const HeightTag tag = make_height_tag(relief, encoded);
  EXPECT_EQ(tag.uri, "data:image/png;base64,YWJj");
  // FIPS 180-4, the example "abc".
  EXPECT_EQ(tag.sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(tag.size, (std::array<int, 2>{20, 10}));
  EXPECT_DOUBLE_EQ(tag.scale_m, 5e-4);
  EXPECT_DOUBLE_EQ(tag.offset_m, -2.5e-4);
  EXPECT_DOUBLE_EQ(tag.rms_m, 1.25e-4);
  EXPECT_DOUBLE_EQ(tag.metres_per_uv.x, 0.01);
  EXPECT_DOUBLE_EQ(tag.metres_per_uv.y, 0.0025);
  EXPECT_EQ(tag.uv_transform, UvTransform{});
  encoded.uri = "grain.png";
  EXPECT_EQ(make_height_tag(relief, encoded).uri, "grain.png");
}

TEST(MaterialTag, RoundTripKeepsEveryBit) {
  std::vector<HapticWarning> warnings;
  EXPECT_EQ(parse_material_tag(to_json(full_tag()), warnings), full_tag());
  EXPECT_TRUE(warnings.empty());
}

TEST(MaterialTag, RoughnessOverTheMapIsVersion2) {
  MaterialTag tag = full_tag();
  tag.roughness = RoughnessTag{2.7, 3.3e-6, {2e-4, 1e-3}, 1.75, 0.3, true};
  const auto json = nlohmann::json::parse(to_json(tag));
  EXPECT_EQ(json["version"], 2);
  EXPECT_DOUBLE_EQ(json["roughness"]["hurst"].get<double>(), 0.3);
  EXPECT_EQ(json["roughness"]["rms"], 3.3e-6);
  EXPECT_EQ(json["roughness"]["wavelength_range"], (std::vector<double>{2e-4, 1e-3}));
  EXPECT_EQ(json["roughness"]["anisotropy"]["ratio"], 1.75);
  EXPECT_EQ(json["roughness"]["overlay"], true);
  std::vector<HapticWarning> warnings;
  EXPECT_EQ(parse_material_tag(to_json(tag), warnings), tag);
  tag.roughness->fractal_dimension.reset();
  EXPECT_FALSE(nlohmann::json::parse(to_json(tag))["roughness"].contains("hurst"));
  EXPECT_EQ(parse_material_tag(to_json(tag), warnings), tag);
  EXPECT_TRUE(warnings.empty());
  EXPECT_THROW(parse_material_tag(R"({"version":3,"stiffness":1})", warnings), InvalidInput);
}

MapsTag full_maps() {
  MapsTag maps;
  maps.uri = "maps.png";
  maps.sha256 = std::string(64, 'b');
  maps.bits = 8;
  maps.size = {64, 32};
  maps.tex_coord = 1;
  maps.uv_transform = {{0.1, 0.2}, 0.3, {2, 3}};
  maps.wrap = {Wrap::mirror, Wrap::clamp};
  maps.channels = {MapChannel{Quantity::stiffness, 300.3, 600.7}, MapChannel{Quantity::dynamic_friction, 0.7 / 3, 0.1},
                   MapChannel{Quantity::damping, -0.1, 0.4}};
  return maps;
}

TEST(MaterialTag, MapsAndBackingAreVersion2) {
  std::vector<HapticWarning> warnings;
  MaterialTag tag = full_tag();
  tag.backing = BackingTag{1800.1, 2.5e-3};
  EXPECT_EQ(nlohmann::json::parse(to_json(tag))["version"], 2);
  EXPECT_EQ(parse_material_tag(to_json(tag), warnings), tag);
  tag.backing.reset();
  tag.maps = full_maps();
  EXPECT_EQ(nlohmann::json::parse(to_json(tag))["version"], 2);
  tag.backing = BackingTag{1800.1, 2.5e-3};
  EXPECT_EQ(parse_material_tag(to_json(tag), warnings), tag);
  EXPECT_TRUE(warnings.empty()) << warnings.front().message;
  const auto json = nlohmann::json::parse(to_json(tag));
  EXPECT_EQ(json["backing"], nlohmann::json::parse(R"({"stiffness":1800.1,"depth":0.0025})"));
  EXPECT_EQ(json["maps"]["channels"]["r"],
            nlohmann::json::parse(R"({"quantity":"stiffness","scale":300.3,"offset":600.7})"));
  EXPECT_EQ(json["maps"]["channels"]["g"]["quantity"], "dynamic_friction");
  EXPECT_EQ(json["maps"]["bits"], 8);
  EXPECT_TRUE(nlohmann::json::parse(tag.other_json.empty() ? "{}" : tag.other_json).empty());
}

TEST(MaterialTag, LargestFrictionIsThatOfTheMaps) {
  MaterialTag tag = full_tag();
  EXPECT_EQ(largest_static_friction(tag), 0.45);
  tag.maps = full_maps();  // Dynamic friction up to 0.1 + 0.7/3.
  EXPECT_NEAR(largest_static_friction(tag), 0.45 / 0.35 * (0.1 + 0.7 / 3), 1e-12);
  tag.maps->channels[1] = MapChannel{Quantity::static_friction, -0.5, 0.9};
  EXPECT_EQ(largest_static_friction(tag), 0.9);
}

/// The members of a maps object that is fine apart from `with`; the codes and places of what is said.
std::string complaint_about_maps(const std::string& channels, const std::string& with = "") {
  std::vector<HapticWarning> warnings;
  const MaterialTag tag = parse_material_tag(R"({"version":2,"stiffness":700,"maps":{"uri":"a.png","sha256":")" +
                                                 std::string(64, 'c') + R"(","channels":)" + channels + with + "}}",
                                             warnings);
  EXPECT_EQ(tag.stiffness, 700);
  std::string all;
  for (const HapticWarning& w : warnings) all += w.code + ' ' + w.message + '\n';
  return all;
}

TEST(MaterialTag, MapsThatAreNoneAreReportedWithTheirPlace) {
  EXPECT_EQ(complaint_about_maps(R"({"r":{"quantity":"stiffness","scale":100}})"), "");
  const auto says = [](const std::string& channels, const std::string& what, const std::string& with = "") {
    const std::string said = complaint_about_maps(channels, with);
    EXPECT_NE(said.find(what), std::string::npos) << channels << ": " << said;
  };
  says("{}", "tag_maps haptic.maps: has no channel");
  says("[]", "tag_maps haptic.maps.channels");
  says(R"({"r":5})", "tag_maps haptic.maps.channels.r = 5: is no object");
  says(R"({"a":{"quantity":"stiffness","scale":1}})", "tag_maps haptic.maps: has no channel");
  says(R"({"r":{"quantity":"colour","scale":1}})", "tag_maps haptic.maps.channels.r: needs a quantity");
  says(R"({"r":{"quantity":"stiffness"}})", "tag_maps haptic.maps.channels.r: needs a quantity");
  says(R"({"r":{"quantity":"stiffness","scale":"1"}})", "tag_maps haptic.maps.channels.r.scale");
  says(R"({"g":{"quantity":"dynamic_friction","scale":-1}})",
       "tag_maps haptic.maps.channels.g: leads from -1.0 to 0.0");
  says(R"({"g":{"quantity":"damping","scale":1e6}})", "tag_maps haptic.maps.channels.g: leads from");
  says(R"({"g":{"quantity":"stiffness","scale":1e300,"offset":1e300}})", "tag_maps haptic.maps.channels.g");
  says(R"({"r":{"quantity":"damping","scale":1},"b":{"quantity":"damping","scale":2}})",
       "tag_maps haptic.maps.channels.b");
  says(R"({"r":{"quantity":"damping","scale":1}})", "tag_maps haptic.maps.texCoord", R"(,"texCoord":99)");
  says(R"({"r":{"quantity":"damping","scale":1}})", "tag_maps haptic.maps.wrap", R"(,"wrap":["repeat"])");
  says(R"({"r":{"quantity":"damping","scale":1}})", "tag_maps haptic.maps.uvTransform.scale",
       R"(,"uvTransform":{"scale":[1,null]})");
  std::vector<HapticWarning> warnings;
  const MaterialTag unsummed = parse_material_tag(
      R"({"version":2,"stiffness":1,"maps":{"uri":"a.png","sha256":"x","channels":{"r":{"quantity":"damping","scale":1}}}})",
      warnings);
  EXPECT_TRUE(has(warnings, "tag_maps_sha256"));
  EXPECT_EQ(unsummed.maps.value().sha256, "");
}

TEST(MaterialTag, MapsLieOnTheCoordinatesOfTheRelief) {
  MaterialTag tag = full_tag();
  tag.maps = full_maps();
  tag.maps->tex_coord = 0;
  std::vector<HapticWarning> warnings;
  EXPECT_FALSE(parse_material_tag(to_json(tag), warnings).maps);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].code, "tag_maps");
  EXPECT_NE(warnings[0].message.find("haptic.maps.texCoord"), std::string::npos);
}

TEST(MaterialTag, BackingsThatAreNoneAreReportedWithTheirPlace) {
  for (const char* backing : {R"({"stiffness":1})", R"({"depth":0.001})", R"({"stiffness":-1,"depth":0.001})",
                              R"({"stiffness":1e9,"depth":0.001})", R"({"stiffness":1,"depth":-1})",
                              R"({"stiffness":1,"depth":2})", R"({"stiffness":"1","depth":0})", "[]", "true"}) {
    std::vector<HapticWarning> warnings;
    const MaterialTag tag =
        parse_material_tag(std::string(R"({"version":2,"stiffness":700,"backing":)") + backing + "}", warnings);
    EXPECT_FALSE(tag.backing) << backing;
    ASSERT_FALSE(warnings.empty()) << backing;
    EXPECT_EQ(warnings[0].code, "tag_backing");
    EXPECT_EQ(warnings[0].message.find("haptic.backing"), 0U) << warnings[0].message;
  }
}

TEST(MaterialTag, RoughnessWithoutPowerLawHasNoDimension) {
  MaterialTag tag = full_tag();
  tag.roughness->fractal_dimension.reset();
  EXPECT_EQ(to_json(tag).find("fractalDimension"), std::string::npos);
  std::vector<HapticWarning> warnings;
  EXPECT_EQ(parse_material_tag(to_json(tag), warnings), tag);
  EXPECT_TRUE(warnings.empty());
}

TEST(MaterialTag, NamesAreThoseOfTheFormat) {
  const auto json = nlohmann::json::parse(to_json(full_tag()));
  EXPECT_EQ(json["version"], 1);
  EXPECT_EQ(json["staticFriction"], 0.45);
  EXPECT_EQ(json["stribeckVelocity"], 0.02);
  EXPECT_EQ(json["height"]["outward"], "black");
  EXPECT_EQ(json["height"]["wrap"], nlohmann::json::parse(R"(["mirror","clamp"])"));
  EXPECT_EQ(json["height"]["uvTransform"]["rotation"], 0.3);
  EXPECT_EQ(json["height"]["metresPerUV"], nlohmann::json::parse("[0.5,0.25]"));
  EXPECT_EQ(json["roughness"]["wavelengthRange"][1], 2e-2);
  EXPECT_EQ(json["symmetry"]["period"][0][0], 0.012);
}

TEST(MaterialTag, DefaultsOfTheLeastTag) {
  std::vector<HapticWarning> warnings;
  const MaterialTag tag = parse_material_tag(R"({"version":1,"stiffness":700})", warnings);
  EXPECT_TRUE(warnings.empty());
  MaterialTag expected;
  expected.stiffness = 700;
  EXPECT_EQ(tag, expected);
}

TEST(MaterialTag, OneFrictionServesForBoth) {
  std::vector<HapticWarning> warnings;
  EXPECT_EQ(parse_material_tag(R"({"version":1,"stiffness":1,"dynamicFriction":0.2})", warnings).static_friction, 0.2);
  EXPECT_EQ(parse_material_tag(R"({"version":1,"stiffness":1,"staticFriction":0.3})", warnings).dynamic_friction, 0.3);
}

TEST(MaterialTag, SaysWhichFrictionIsUsedInstead) {
  std::vector<HapticWarning> warnings;
  const MaterialTag tag =
      parse_material_tag(R"({"version":1,"stiffness":1,"staticFriction":-1,"dynamicFriction":0.25})", warnings);
  EXPECT_EQ(tag.static_friction, 0.25);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].message.find("dynamicFriction is used"), std::string::npos) << warnings[0].message;
}

struct Odd {
  const char* json;
  const char* code;
};

class OddValue : public ::testing::TestWithParam<Odd> {};

TEST_P(OddValue, IsReportedAndReplacedByTheDefault) {
  std::vector<HapticWarning> warnings;
  const MaterialTag tag = parse_material_tag(GetParam().json, warnings);
  EXPECT_TRUE(has(warnings, GetParam().code)) << GetParam().json;
  EXPECT_GE(tag.stiffness, 0);
  EXPECT_GE(tag.dynamic_friction, 0);
  EXPECT_LE(tag.dynamic_friction, tag.static_friction);
  EXPECT_GT(tag.stribeck_velocity, 0);
  for (const HapticWarning& warning : warnings) EXPECT_EQ(warning.message.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    MaterialTag, OddValue,
    ::testing::Values(
        Odd{R"({"version":1,"stiffness":"NaN"})", "tag_stiffness"},
        Odd{R"({"version":1,"stiffness":null})", "tag_stiffness"},
        Odd{R"({"version":1,"stiffness":-5})", "tag_stiffness"},
        Odd{R"({"version":1,"stiffness":1e300})", "tag_stiffness"},
        Odd{R"({"version":1,"stiffness":1,"damping":-1})", "tag_damping"},
        Odd{R"({"version":1,"stiffness":1,"staticFriction":-0.1})", "tag_friction"},
        Odd{R"({"version":1,"stiffness":1,"staticFriction":0.1,"dynamicFriction":0.5})", "tag_friction"},
        Odd{R"({"version":1,"stiffness":1,"stribeckVelocity":0})", "tag_stribeck"},
        Odd{R"({"version":1,"stiffness":1,"height":"x.png"})", "tag_height"},
        Odd{R"({"version":1,"height":{"offset":0}})", "tag_height"},
        Odd{R"({"version":1,"height":{"scale":1e-4,"sha256":"12"}})", "tag_height_sha256"},
        Odd{R"({"version":1,"height":{"scale":1e-4,"bits":8}})", "tag_height_bits"},
        Odd{R"({"version":1,"height":{"scale":1e-4,"metresPerUV":[0,1]}})", "tag_height_uv"},
        Odd{R"({"version":1,"height":{"scale":1e-4,"wrap":["repeat"]}})", "tag_height_uv"},
        Odd{R"({"version":1,"height":{"scale":1e-4,"uvTransform":7}})", "tag_height_uv"},
        Odd{R"({"version":1,"stiffness":1,"roughness":{"rmsHeight":1e-5,"fractalDimension":7}})", "tag_roughness"},
        Odd{R"({"version":1,"stiffness":1,"forceModel":{"name":"spoon"}})", "tag_force_model"},
        Odd{R"({"version":1,"stiffness":1,"frictionModel":{"name":"glue"}})", "tag_friction_model"},
        Odd{R"({"version":1,"stiffness":1,"frictionModel":{"name":"bristle","stiffness":-1}})", "tag_friction_model"},
        Odd{R"({"version":1,"stiffness":1,"forceShading":1})", "tag_force_shading"},
        Odd{R"({"version":1,"stiffness":1,"forceModel":{"name":"lateral","amplitude":-1}})", "tag_force_model"},
        Odd{R"({"version":1,"stiffness":1,"forceModel":{"name":"lateral","form":"place"}})", "tag_force_model"},
        Odd{R"({"version":1,"stiffness":1,"forceModel":{"name":"graph","level":9}})", "tag_force_model"},
        Odd{R"({"version":1,"stiffness":1,"symmetry":{"period":[1,2]}})", "tag_symmetry"},
        Odd{R"({"version":1,"stiffness":1,"provenance":{"tool":3}})", "tag_provenance"}));

TEST(MaterialTag, ForceModelsKeepTheirMembers) {
  for (const ForceModelTag& model : {ForceModelTag{"lateral", 0.02, true, "displacement", 8},
                                     ForceModelTag{"graph-lateral", 0.01, false, "place", 5},
                                     ForceModelTag{"textured-normal", 0.01, false, "", 8}}) {
    std::vector<HapticWarning> warnings;
    MaterialTag tag;
    tag.force_model = model;
    EXPECT_EQ(parse_material_tag(to_json(tag), warnings), tag);
    EXPECT_TRUE(warnings.empty());
  }
  std::vector<HapticWarning> warnings;
  const auto read = [&](const std::string& model) {
    return parse_material_tag(R"({"version":1,"stiffness":1,"forceModel":)" + model + "}", warnings).force_model;
  };
  EXPECT_EQ(read(R"({"name":"graph","sign":"physical"})")->literal, false);
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(read(R"({"name":"lateral","form":"place"})")->form, "");
  EXPECT_EQ(read(R"({"name":"graph","level":0})")->level, 8);
  EXPECT_EQ(warnings.size(), 2U);
}

TEST(MaterialTag, HeightWithoutScaleIsDropped) {
  std::vector<HapticWarning> warnings;
  EXPECT_FALSE(parse_material_tag(R"({"version":1,"height":{"scale":"1"}})", warnings).height);
  EXPECT_TRUE(has(warnings, "tag_height"));
}

TEST(MaterialTag, RefusesWhatIsNoTag) {
  std::vector<HapticWarning> warnings;
  for (const char* json :
       {"", "nonsense", "[]", "1", "{}", R"({"version":1})", R"({"version":3,"stiffness":1})",
        R"({"version":"1","stiffness":1})", R"({"stiffness":1})", R"({"version":1,"stiffness":NaN})"})
    EXPECT_THROW(parse_material_tag(json, warnings), InvalidInput) << json;
}

TEST(MaterialTag, RefusedTagInExtrasIsAWarningAndStays) {
  std::vector<HapticWarning> warnings;
  const std::string refused = R"({"haptic":{"version":9,"stiffness":1}})";
  std::string extras = refused;
  EXPECT_FALSE(take_material_tag(extras, warnings));
  EXPECT_TRUE(has(warnings, "tag_refused"));
  EXPECT_EQ(extras, refused);
}

TEST(MaterialTag, ExtrasWithoutTagAreSilent) {
  std::vector<HapticWarning> warnings;
  for (const std::string text : {"", R"({"a":1})", "[1]"}) {
    std::string extras = text;
    EXPECT_FALSE(take_material_tag(extras, warnings));
    EXPECT_EQ(extras, text);
  }
  EXPECT_TRUE(warnings.empty());
}

TEST(MaterialTag, IsTakenOutOfExtrasThatKeepTheirOtherMembers) {
  std::vector<HapticWarning> warnings;
  std::string extras = R"({"a":[1,{"b":null}],"haptic":)" + to_json(full_tag()) + R"(,"c":2.5})";
  EXPECT_EQ(take_material_tag(extras, warnings), full_tag());
  EXPECT_EQ(extras, R"({"a":[1,{"b":null}],"c":2.5})");
  extras = R"({"haptic":)" + to_json(full_tag()) + "}";
  EXPECT_TRUE(take_material_tag(extras, warnings));
  EXPECT_EQ(extras, "");
  EXPECT_TRUE(warnings.empty());
}

TEST(MaterialTag, MembersOfOthersAreKept) {
  std::vector<HapticWarning> warnings;
  const MaterialTag tag = parse_material_tag(R"({"version":1,"stiffness":3,"vendor":{"a":[1]},"b":null})", warnings);
  EXPECT_EQ(tag.other_json, R"({"vendor":{"a":[1]},"b":null})");
  EXPECT_EQ(nlohmann::json::parse(to_json(tag))["vendor"], nlohmann::json::parse(R"({"a":[1]})"));
  EXPECT_EQ(parse_material_tag(to_json(tag), warnings), tag);
}

TEST(MaterialTag, DamagedTextNeverDoesMoreThanThrow) {
  const std::string whole = to_json(full_tag());
  std::mt19937 random(1);
  int accepted = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = whole;
    for (int k = 0; k < 3; ++k) text[random() % text.size()] = static_cast<char>(random() % 256);
    std::vector<HapticWarning> warnings;
    try {
      const MaterialTag tag = parse_material_tag(text, warnings);
      EXPECT_TRUE(std::isfinite(tag.stiffness) && tag.stiffness >= 0);
      ++accepted;
    } catch (const InvalidInput&) {
    }
  }
  EXPECT_GT(accepted, 10);
}

}  // namespace
}  // namespace papilla
