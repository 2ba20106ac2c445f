// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace papilla::bench {

/// A promise, what was measured of it, and whether it holds; `holds` is empty where nothing could be measured.
struct Target {
  std::string promise, measured;
  std::optional<bool> holds;
};

/// Rows behind the targets, for instance one per file.
struct EvidenceTable {
  std::string title, note;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// A Markdown page: how it was made, the targets, the tables, and the ratios of a benchmark's JSON.
std::string evidence_page(const nlohmann::ordered_json& report, const std::vector<Target>& targets,
                          const std::vector<EvidenceTable>& tables, const std::string& command);

}  // namespace papilla::bench
