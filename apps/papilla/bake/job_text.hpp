// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "json/json.hpp"
#include "papilla/pipeline/bake_jobs.hpp"

namespace papilla::app {

std::string job_line(const std::string& job, const JobResult& result);
Json job_json(const std::string& id, const JobResult& result);

/// One line of FOLDER/manifest.jsonl, for schedulers and for merge. @param folder as `command` names it.
Json manifest_json(const BakeJob& job, const std::filesystem::path& folder);

/// What merge needs of FOLDER/manifest.jsonl.
/// @throws IoError; InvalidInput naming the file and the line.
std::vector<BakeJob> read_manifest(const std::filesystem::path& folder);

std::filesystem::path manifest_of(const std::filesystem::path& folder);

}  // namespace papilla::app
