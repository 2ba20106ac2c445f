// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <set>
#include <thread>

#include "evaluate/extreme_meshes.hpp"
#include "evaluate/suite.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/statistics.hpp"

namespace papilla {
namespace {

TEST(Stability, CellsTellErrorsFromResults) {
  const StabilityRun run{{}, Budget()};
  const auto outcome = [&](const std::function<void(StabilityCell&)>& work) {
    return measured_cell(run, "m", "i", work).outcome;
  };
  EXPECT_EQ(outcome([](StabilityCell&) {}), Outcome::holds);
  EXPECT_EQ(outcome([](StabilityCell&) { throw InvalidInput("no"); }), Outcome::refuses);
  EXPECT_EQ(outcome([](StabilityCell&) { throw SolverFailure("no"); }), Outcome::fails);
  EXPECT_EQ(outcome([](StabilityCell& cell) { cell.error = std::numeric_limits<double>::quiet_NaN(); }),
            Outcome::breaks);
  EXPECT_EQ(measured_cell({{}, Budget(0)}, "m", "i", [](StabilityCell&) { FAIL(); }).outcome, Outcome::not_run);
}

/// Every method on every input, once.
void expect_full(const StabilitySuite& suite) {
  std::set<std::string> methods, inputs;
  std::set<std::pair<std::string, std::string>> pairs;
  for (const StabilityCell& cell : suite.cells) {
    methods.insert(cell.method);
    inputs.insert(cell.input);
    pairs.insert({cell.method, cell.input});
  }
  EXPECT_EQ(pairs.size(), suite.cells.size());
  EXPECT_EQ(pairs.size(), methods.size() * inputs.size());
}

struct Named {
  std::string name;
};

TEST(Stability, WhatWasQuickComesFirst) {
  const std::vector<Named> inputs{{"first"}, {"second"}}, methods{{"dear"}, {"quick"}};
  std::vector<std::string> ran;
  StabilitySuite suite;
  fill_suite(suite, {{}, Budget()}, inputs, methods, [&](const Named& method, const Named& input, StabilityCell&) {
    if (method.name == "dear" && input.name == "first") std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ran.push_back(method.name);
  });
  EXPECT_EQ(ran, (std::vector<std::string>{"dear", "quick", "quick", "dear"}));
  expect_full(suite);
  EXPECT_EQ(suite.cells[2].method, "dear");
  EXPECT_EQ(suite.cells[2].input, "second");
}

TEST(Stability, WallsShakeUnlessTheyAreLimited) {
  const StabilitySuite suite = contact_stability({{}, Budget()});
  expect_full(suite);
  int shaking = 0;
  for (const StabilityCell& cell : suite.cells) {
    if (cell.method.find("limit") == 0) {
      EXPECT_EQ(cell.outcome, Outcome::holds) << cell.input << ": " << cell.note;
    }
    shaking += cell.method == "as asked" && cell.outcome == Outcome::breaks;
    if (cell.method == "as asked" && cell.input == "1e+06 N/m") {
      EXPECT_EQ(cell.outcome, Outcome::breaks);
    }
  }
  EXPECT_GE(shaking, 3);
}

TEST(Stability, LatticesAreFoundWhereTheyAreAndNowhereElse) {
  const StabilitySuite suite = lattice_stability({{}, Budget()});
  expect_full(suite);
  for (const StabilityCell& cell : suite.cells) {
    if (cell.input == "not a number") {
      EXPECT_EQ(cell.outcome, Outcome::refuses);
    }
    if (cell.method == "squared, best") {
      EXPECT_NE(cell.outcome, Outcome::breaks) << cell.input << ": " << cell.note;
    }
  }
}

TEST(Stability, ExtremeMeshesAreWhatTheyAreCalled) {
  std::vector<NamedMesh> meshes = extreme_meshes();
  std::erase_if(meshes, [](const NamedMesh& m) { return m.mesh.triangles.size() > 100000; });
  for (const auto& [name, mesh] : meshes) {
    const MeshStatistics s = mesh_statistics(mesh);
    EXPECT_EQ(s.nonmanifold_edges, 0U) << name;
    EXPECT_EQ(s.flipped_edges, 0U) << name;
    EXPECT_EQ(s.components, 1U) << name;
    EXPECT_EQ(s.boundary_loops, 1U) << name;
    EXPECT_EQ(s.genus, 0) << name;
  }
  EXPECT_NEAR(mesh_statistics(meshes[4].mesh).area_mm2 / static_cast<double>(meshes[4].mesh.triangles.size()), 1e-20,
              2e-21);
  EXPECT_NEAR(mesh_statistics(meshes[5].mesh).area_mm2 / static_cast<double>(meshes[5].mesh.triangles.size()), 1e20,
              2e19);
}

}  // namespace
}  // namespace papilla
