// SPDX-License-Identifier: MIT
#include "materials_mutator.hpp"

namespace papilla::fuzz {

const JsonGrammar& materials_grammar() {
  static const JsonGrammar grammar{{{"time", 0, 1},
                                    {"size_mm", 1e-3, 1e5},
                                    {"stiffness", 1e-3, 1e6},
                                    {"damping", 0, 1e4},
                                    {"staticFriction", 0, 10},
                                    {"dynamicFriction", 0, 10},
                                    {"stribeckVelocity", 1e-6, 10},
                                    {"roughness", 0, 1},
                                    {"metallic", 0, 1},
                                    {"depth_mm", 1e-6, 100},
                                    {"scale", 0, 100},
                                    {"max_slope", 0.01, 1000}},
                                   {{"method", {"auto", "variational", "pentland", "tsai-shah", "intensity"}},
                                    {"unwrap", {"auto", "best", "triplanar", "lscm", "levy", "maillot", "natural"}},
                                    {"border", {"convex", "released", "free"}},
                                    {"grain", {"up", "longest"}},
                                    {"show", {"auto", "picture", "relief"}},
                                    {"name", {"coulomb", "bristle"}},
                                    {"texture", {"grain.png"}},
                                    {"material", {"grain", "chrome"}},
                                    {"part", {"*", "p", "q*", "[a"}},
                                    {"node", {"**", "*", "a/**/b", ""}},
                                    {"layer", {"*", "hidden"}},
                                    {"color", {"#000000", "#FFffFF", "#20a0ff"}},
                                    {"cad_colour", {"#ffffff", "#202020"}},
                                    {"gltf_material", {"*", "Leather", "L?ather", ""}}},
                                   Json::parse(R"({"$comment":"c","version":1,"materials":{
        "grain":{"texture":"grain.png","time":0.5,"size_mm":[40,40],"stiffness":900,"damping":0.4,"staticFriction":0.45,
          "dynamicFriction":0.35,"stribeckVelocity":0.01,"frictionModel":{"name":"bristle","stiffness":300},"backing":{"stiffness":1800,"depth_mm":2},
          "maps":{"stiffness":"a.png","friction":{"picture":"noise","range":[0,2]},"range":[0.5,1.5]},
          "fineRoughness":{"hurst":0.5,"rms":1e-6,"wavelength_range":[1e-5,1e-3]},
          "forceShading":true,"height":{"method":"auto","depth_mm":0.3,"scale":1,"max_slope":0.5},"unwrap":{"method":"best","grain":"up","grain_of":{"q*":{"edge":[1,2,3]}}},
          "show":"picture","color":"#808080","roughness":0.5,"metallic":0,"$comment":"c"},
        "chrome":{"stiffness":2000,"color":"#808080"}},
        "assign":[{"part":"*","cad_colour":"#ffffff","gltf_material":"*","node":"**","not":{"layer":"hidden"},
          "material":"grain","$comment":"c"},{"part":"q","material":null}]})")};
  return grammar;
}

void repair_materials(Json& rules) {
  const JsonGrammar& grammar = materials_grammar();
  const Json& sample = grammar.sample;
  if (!rules.is_object()) rules = Json::object();
  rules.erase("version");
  for (const char* key : {"materials", "assign"})
    if (!rules.contains(key) || rules[key].type() != sample[key].type()) rules[key] = sample[key];
  for (auto& [name, material] : rules["materials"].items()) {
    fit_json(material, sample["materials"]["grain"], grammar);
    if (material.contains("staticFriction") && material.contains("dynamicFriction") &&
        material["dynamicFriction"] > material["staticFriction"])
      material["dynamicFriction"] = material["staticFriction"];
  }
  for (Json& rule : rules["assign"]) {
    const bool empty = rule.is_object() && rule.contains("material") && rule["material"].is_null();
    fit_json(rule, sample["assign"][0], grammar);
    if (rule.contains("not") && rule["not"].empty()) rule.erase("not");
    if (!rule.contains("part") && !rule.contains("cad_colour") && !rule.contains("gltf_material")) rule["part"] = "*";
    if (!rule.contains("material") || !rules["materials"].contains(rule["material"].get<std::string>()) || empty)
      rule["material"] = empty || rules["materials"].empty() ? Json() : Json(rules["materials"].begin().key());
  }
  for (auto member = rules.begin(); member != rules.end();)
    member = sample.contains(member.key()) ? std::next(member) : rules.erase(member);
}

}  // namespace papilla::fuzz
