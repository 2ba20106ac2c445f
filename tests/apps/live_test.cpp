// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>

#include "live/player_link.hpp"
#include "live_socket.hpp"
#include "papilla/core/error.hpp"
#include "player/live_publisher.hpp"
#include "verb.hpp"

namespace papilla {
namespace {

using app::Json;
using app::PlayerLink;
using player::LivePublisher;
using namespace std::chrono_literals;

constexpr auto k_patience = 5s;
constexpr const char* k_greeting = R"({"papilla_live":1,"file":"a.glb","device":"sim","rate_hz":1000})";

std::string socket_path() { return testing::TempDir() + "papilla-" + std::to_string(::getpid()) + ".sock"; }

RecordRow row(double z) {
  RecordRow row;
  row.t = 0.25;
  row.probe = {1, 2, z};
  row.force = {0, 0, 3};
  row.in_contact = true;
  return row;
}

/// What the events say of the name, in order.
std::vector<Json> named(const std::string& events, const std::string& name) {
  std::vector<Json> found;
  const std::string head = "event: " + name + "\ndata: ";
  for (std::size_t at = events.find(head); at != std::string::npos; at = events.find(head, at + 1)) {
    const std::size_t begin = at + head.size();
    found.push_back(Json::parse(events.substr(begin, events.find('\n', begin) - begin)));
  }
  return found;
}

/// Reads on until the state is there.
std::vector<Json> wait_for(PlayerLink& link, std::uint64_t& seen, const std::string& state) {
  const auto end = std::chrono::steady_clock::now() + k_patience;
  while (std::chrono::steady_clock::now() < end) {
    const std::string events = link.events(seen, 100ms);
    const std::vector<Json> states = named(events, "state");
    if (!states.empty() && states.back()["state"] == state) return states;
  }
  ADD_FAILURE() << "the state never became " << state;
  return {};
}

TEST(LiveLine, NoNumberBecomesNull) {
  RecordRow bad = row(0.5);
  bad.proxy.x = std::numeric_limits<double>::quiet_NaN();
  const Json json = Json::parse(player::live_line(7, bad));
  EXPECT_EQ(json["tick"], 7);
  EXPECT_EQ(json["probe"], Json({1.0, 2.0, 0.5}));
  EXPECT_TRUE(json["proxy"].is_null());
  EXPECT_EQ(json["contact"], true);
}

TEST(Live, SeveralFollowOnePlayerAndTheNext) {
  const std::string path = socket_path();
  PlayerLink one(path), two(path);
  std::uint64_t seen_one = 0, seen_two = 0;
  EXPECT_EQ(named(one.events(seen_one, 0ms), "state").back()["state"], "waiting");
  for (int life = 0; life < 2; ++life) {
    {
      LivePublisher publisher(path, k_greeting);
      for (auto [link, seen] : {std::pair(&one, &seen_one), std::pair(&two, &seen_two)}) {
        const auto states = wait_for(*link, *seen, "playing");
        ASSERT_FALSE(states.empty());
        EXPECT_EQ(states.back()["file"], "a.glb");
      }
      publisher.slot().store(row(1));
      publisher.slot().store(row(4 + life));
      for (auto [link, seen] : {std::pair(&one, &seen_one), std::pair(&two, &seen_two)}) {
        std::vector<Json> samples;
        for (int i = 0; i < 50 && (samples.empty() || samples.back()["tick"] != 2); ++i)
          if (auto more = named(link->events(*seen, 100ms), "sample"); !more.empty()) samples = more;
        ASSERT_FALSE(samples.empty());
        EXPECT_EQ(samples.back()["probe"][2], 4.0 + life);
      }
    }
    wait_for(one, seen_one, "ended");
    wait_for(two, seen_two, "ended");
  }
}

TEST(Live, WhoNeverReadsHoldsUpNobody) {
  const std::string path = socket_path();
  // More than waits in a connection that nobody reads.
  LivePublisher publisher(path, R"({"papilla_live":1,"file":")" + std::string(50000, 'a') + "\"}");
  const int deaf = app::connect_live(path);
  ASSERT_GE(deaf, 0);
  PlayerLink link(path);
  std::uint64_t seen = 0;
  wait_for(link, seen, "playing");
  for (int i = 1; i <= 30; ++i) {
    publisher.slot().store(row(i));
    EXPECT_EQ(named(link.events(seen, k_patience), "sample").size(), 1U) << i;
  }
  ::close(deaf);
}

TEST(Live, TheSocketIsTheUsersAlone) {
  const std::string path = socket_path();
  {
    const LivePublisher publisher(path, k_greeting);
    struct stat about {};
    ASSERT_EQ(::stat(path.c_str(), &about), 0);
    EXPECT_EQ(about.st_mode & 0777, 0600U);
    EXPECT_THROW(LivePublisher(path, k_greeting), IoError);  // Somebody listens there.
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  std::ofstream(path) << "a file";
  EXPECT_THROW(LivePublisher(path, k_greeting), IoError);
  EXPECT_TRUE(std::filesystem::exists(path));
  std::filesystem::remove(path);

  const int killed = ::socket(AF_UNIX, SOCK_STREAM, 0);  // What a killed player leaves.
  const sockaddr_un address = app::live_address(path);
  ASSERT_EQ(::bind(killed, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ::close(killed);
  EXPECT_NO_THROW(LivePublisher(path, k_greeting));
  EXPECT_THROW(app::live_address(std::string(200, 'x')), InvalidInput);
  EXPECT_THROW(app::live_address(""), InvalidInput);
}

}  // namespace
}  // namespace papilla
