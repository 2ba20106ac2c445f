// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_baking.hpp"

#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "studio/studio_answers.hpp"
#include "studio/studio_review.hpp"

namespace papilla::app {

namespace fs = std::filesystem;

Json StudioBaking::start(const Json& wanted) {
  const std::scoped_lock lock(mutex_);
  if (!desk_.scene()) throw InvalidInput("there is no scene to bake");
  const std::string output = wanted.value("output", desk_.default_output()),
                    report = wanted.value("report", std::string());
  const std::string extension = files_.checked(output).extension().string();
  if (extension != ".glb" && extension != ".gltf") throw InvalidInput("'" + output + "' must end in .glb or .gltf");
  if (!report.empty()) files_.checked((fs::path(report) / "index.html").string());
  if (bake_ && bake_->is_running()) throw InvalidInput("a bake is under way");
  Json state = desk_.save();
  bake_.reset();
  const std::vector<std::string> words = desk_.bake_words(output, report);
  report_ = report;
  bake_ = std::make_unique<StudioBake>(
      words, [this, output, report](const StudioBake::News& news) { tell(news, output, report); });
  return {{"command", shell_line(words)}, {"state", std::move(state)}};
}

void StudioBaking::tell(const StudioBake::News& news, const std::string& output, const std::string& report) {
  static constexpr const char* names[] = {"running", "done", "failed", "cancelled"};
  Json event = {{"event", "bake"},           {"state", names[static_cast<std::size_t>(news.state)]},
                {"stage", news.stage},       {"fraction", news.fraction},
                {"messages", news.messages}, {"output", output},
                {"report", report}};
  std::error_code error;
  if (const auto bytes = fs::file_size(output, error); !error && news.state == StudioBake::News::State::done)
    event["bytes"] = bytes;
  events_.tell(event);
}

void StudioBaking::cancel() {
  const std::scoped_lock lock(mutex_);
  if (bake_) bake_->cancel();
}

void StudioBaking::end() {
  const std::scoped_lock lock(mutex_);
  bake_.reset();
}

PageAnswer StudioBaking::report_page() const {
  const std::scoped_lock lock(mutex_);
  if (report_.empty()) throw InvalidInput("no report was written");
  return bytes_answer("text/html; charset=utf-8", std::make_shared<const std::string>(
                                                      with_review(read_file(files_.checked(report_ + "/index.html")))));
}

void add_bake_routes(StudioRoutes& routes, StudioBaking& baking) {
  routes.post["/bake"] = [&baking](const Query&, const std::string& body) {
    return json_answer(baking.start(parsed(body)));
  };
  routes.post["/bake-cancel"] = [&baking](const Query&, const std::string&) {
    baking.cancel();
    return json_answer(Json::object());
  };
  routes.get["/report"] = [&baking](const Query&) { return baking.report_page(); };
}

}  // namespace papilla::app
