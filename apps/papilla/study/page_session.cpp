// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/page_session.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <exception>
#include <memory>
#include <set>
#include <thread>
#include <vector>

#include "http/page_server.hpp"
#include "json/json.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"

namespace papilla::app {
namespace {

constexpr std::chrono::milliseconds k_look{50}, k_last_answer{500};
constexpr unsigned k_ok = 200, k_conflict = 409;

std::atomic<bool> g_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

PageAnswer json_answer(const Json& json, unsigned status = k_ok) {
  return {status, "application/json",
          std::make_shared<const std::string>(json.dump(-1, ' ', false, Json::error_handler_t::replace))};
}

PageAnswer refusal(const std::string& reason) { return json_answer({{"error", reason}}, k_conflict); }

/// Runs `work`; what it throws becomes a message on the page.
template <class Work>
PageAnswer told(const Work& work) {
  try {
    return work();
  } catch (const std::exception& error) {
    return refusal(error.what());
  }
}

/// What the server's thread and the program's share.
struct Shared {
  StudySession& session;
  StimulusPlayer& player;
  std::atomic<bool> is_done{false};
  std::exception_ptr failure;  ///< Set before is_done.
};

Json state_of(Shared& shared) {
  return {
      {"place", shared.session.next()}, {"playing", shared.player.is_playing()}, {"failure", shared.player.failure()}};
}

PageAnswer take_answer(Shared& shared, const std::string& body) {
  const Json said = Json::parse(body);
  shared.player.is_playing();  // A player that has ended tells how.
  if (const std::string failure = shared.player.failure(); !failure.empty())
    return refusal("a plate was not there, so that no answer is taken, play it again: " + failure);
  try {
    const std::string why = shared.session.record(
        said.at("place").get<std::size_t>(), said.at("answer").get<std::string>(), said.at("seconds").get<double>());
    if (!why.empty()) return refusal(why);
  } catch (const IoError&) {
    shared.failure = std::current_exception();  // A full disk is the end, not a message only.
    shared.is_done = true;
    throw;
  }
  const PageAnswer answer = json_answer(state_of(shared));
  if (shared.session.next() > shared.session.trials()) shared.is_done = true;
  return answer;
}

PageAnswer play(Shared& shared, const std::string& body) {
  const auto wanted = Json::parse(body).at("file").get<std::string>();
  const std::vector<StudyStimulus>& stimuli = shared.session.study().stimuli;
  if (std::none_of(stimuli.begin(), stimuli.end(), [&](const StudyStimulus& s) { return s.file == wanted; }))
    return refusal("there is no such stimulus");
  if (!shared.player.plays()) return refusal("no --device is given: run the command in a terminal");
  shared.player.start(shared.session.file(wanted));
  return json_answer(state_of(shared));
}

PageRoutes routes_of(Shared& shared) {
  const auto page = std::make_shared<const std::string>(session_page(shared.session, shared.player));
  PageRoutes routes;
  routes.get["/"] = [page] { return PageAnswer{k_ok, "text/html; charset=utf-8", page}; };
  routes.get["/state"] = [&shared] { return json_answer(state_of(shared)); };
  routes.post["/answer"] = [&shared](const std::string& body) {
    return told([&] { return take_answer(shared, body); });
  };
  routes.post["/play"] = [&shared](const std::string& body) { return told([&] { return play(shared, body); }); };
  routes.post["/stop"] = [&shared](const std::string&) {
    shared.player.stop();
    return json_answer(state_of(shared));
  };
  std::set<std::string> pictures;
  for (const StudyTrial& trial : shared.session.study().trials)
    pictures.insert(trial.pictures.begin(), trial.pictures.end());
  for (const std::string& picture : pictures) {
    const auto bytes = std::make_shared<const std::string>(read_file(shared.session.file(picture)));
    routes.get["/" + picture] = [bytes] { return PageAnswer{k_ok, "image/png", bytes}; };
  }
  return routes;
}

}  // namespace

std::string run_on_page(StudySession& session, StimulusPlayer& player, int port, const Deadline& deadline,
                        const std::function<void(const std::string&)>& ready) {
  Shared shared{session, player, {}, {}};
  shared.is_done = session.next() > session.trials();
  std::string url;
  {
    const PageServer server(routes_of(shared), port);
    url = server.url();
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { g_stop = true; });
    ready(url);
    while (!g_stop && !shared.is_done && !deadline.passed()) std::this_thread::sleep_for(k_look);
    if (shared.is_done) std::this_thread::sleep_for(k_last_answer);  // The page still gets its answer.
  }
  player.stop();
  if (shared.failure) std::rethrow_exception(shared.failure);
  return url;
}

}  // namespace papilla::app
