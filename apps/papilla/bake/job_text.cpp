// SPDX-License-Identifier: GPL-3.0-or-later
#include "job_text.hpp"

#include <sstream>

#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "shown_format.hpp"

namespace papilla::app {

namespace fs = std::filesystem;

std::string job_line(const std::string& job, const JobResult& result) {
  if (result.was_done) return shown_format("{}: was done\n", job);
  return shown_format("{}: {} surfaces in {:.2f} s\n", job, result.surfaces, result.seconds);
}

Json job_json(const std::string& id, const JobResult& result) {
  return {{"job", id}, {"was_done", result.was_done}, {"surfaces", result.surfaces}, {"seconds", result.seconds}};
}

fs::path manifest_of(const fs::path& folder) { return folder / "manifest.jsonl"; }

Json manifest_json(const BakeJob& job, const fs::path& folder) {
  Json surfaces = Json::array();
  for (const JobSurface& surface : job.surfaces)
    surfaces.push_back({{"part", surface.part}, {"slot", surface.slot}, {"label", surface.label}});
  return {{"id", job.id},
          {"command", {"papilla", "bake", "--job", (folder / job.id).string()}},
          {"inputs",
           Json::array({{{"file", "inputs/" + job.id}, {"sha256", job.input_sha256}, {"bytes", job.input_bytes}}})},
          {"result", "results/" + job.id},
          {"surfaces", surfaces},
          {"triangles", job.triangles},
          {"cost_seconds", job.cost_seconds}};
}

std::vector<BakeJob> read_manifest(const fs::path& folder) {
  const fs::path path = manifest_of(folder);
  std::istringstream lines(read_file(path));
  std::vector<BakeJob> jobs;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) try {
      if (line.empty()) continue;
      const Json json = Json::parse(line);
      BakeJob job;
      job.id = json.at("id").get<std::string>();
      if (fs::path(job.id).filename() != job.id) throw InvalidInput("'" + job.id + "' is no id");
      for (const Json& surface : json.at("surfaces"))
        job.surfaces.push_back({surface.at("part").get<std::uint32_t>(), surface.at("slot").get<std::uint32_t>(),
                                surface.at("label").get<std::string>()});
      jobs.push_back(std::move(job));
    } catch (const Json::exception& error) {
      throw InvalidInput(shown_format("{}: line {}: is no job: {}", path.string(), number, error.what()));
    } catch (const InvalidInput& error) {
      throw InvalidInput(shown_format("{}: line {}: {}", path.string(), number, error.what()));
    }
  return jobs;
}

}  // namespace papilla::app
