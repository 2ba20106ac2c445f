// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <thread>
#include <vector>

#include "live/player_link.hpp"
#include "live_socket.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "player/live_publisher.hpp"
#include "verb.hpp"

namespace papilla {
namespace {

using app::Json;
using app::PlayerLink;
using player::LivePublisher;
using namespace std::chrono_literals;

constexpr auto k_patience = 60s;
constexpr const char* k_greeting = R"({"papilla_live":1,"file":"a.glb","device":"sim","rate_hz":1000})";

/// A socket's path in a folder of its own.
class Place {
 public:
  std::string path() const { return folder_.path() / "player.sock"; }
  const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  TemporaryFolder folder_{"papilla-live"};
};

/// With it a line is longer than what waits in a connection that nobody reads.
const std::string k_long_greeting = R"({"papilla_live":1,"file":")" + std::string(50000, 'a') + "\"}";

int silent_client(const std::string& path) {
  const int connection = app::connect_live(path);
  EXPECT_GE(connection, 0);
  return connection;
}

/// What `work` returns in a process of user 65534, with this user's open files.
int as_another_user(const std::function<int()>& work) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(::setresuid(65534, 65534, 65534) == 0 ? work() : 99);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

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

/// The next events, waited for.
std::string next_events(PlayerLink& link, std::uint64_t& seen) {
  const auto end = std::chrono::steady_clock::now() + k_patience;
  std::string events;
  while (events.empty() && std::chrono::steady_clock::now() < end) {
    events = link.events(seen);
    if (events.empty()) std::this_thread::sleep_for(1ms);
  }
  return events;
}

/// Reads on until the state is there.
std::vector<Json> wait_for(PlayerLink& link, std::uint64_t& seen, const std::string& state) {
  const auto end = std::chrono::steady_clock::now() + k_patience;
  while (std::chrono::steady_clock::now() < end) {
    const std::vector<Json> states = named(next_events(link, seen), "state");
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
  const Place place;
  const std::string path = place.path();
  PlayerLink one(path), two(path);
  std::uint64_t seen_one = 0, seen_two = 0;
  EXPECT_EQ(named(one.events(seen_one), "state").back()["state"], "waiting");
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
          if (auto more = named(next_events(*link, *seen), "sample"); !more.empty()) samples = more;
        ASSERT_FALSE(samples.empty());
        EXPECT_EQ(samples.back()["probe"][2], 4.0 + life);
      }
    }
    wait_for(one, seen_one, "ended");
    wait_for(two, seen_two, "ended");
  }
}

/// That a follower gets samples, one after the other.
void expect_samples(LivePublisher& publisher, PlayerLink& link, std::uint64_t seen, int count) {
  for (int i = 1; i <= count; ++i) {
    publisher.slot().store(row(i));
    std::vector<Json> samples;
    const auto end = std::chrono::steady_clock::now() + k_patience;
    while ((samples.empty() || samples.back()["probe"][2] != i) && std::chrono::steady_clock::now() < end)
      samples = named(next_events(link, seen), "sample");
    ASSERT_FALSE(samples.empty()) << i;
  }
}

TEST(Live, WhoNeverReadsHoldsUpNobodyAndIsDropped) {
  const Place place;
  LivePublisher publisher(place.path(), k_long_greeting);
  const int deaf = silent_client(place.path());
  PlayerLink link(place.path());
  std::uint64_t seen = 0;
  wait_for(link, seen, "playing");
  expect_samples(publisher, link, seen, 30);
  pollfd ended{deaf, 0, 0};
  EXPECT_EQ(::poll(&ended, 1, 60000), 1) << "a client that takes nothing keeps its place";
  expect_samples(publisher, link, seen, 3);
  ::close(deaf);
}

TEST(Live, SilentClientsKeepNobodyOut) {
  const Place place;
  LivePublisher publisher(place.path(), k_long_greeting);
  std::vector<int> silent;
  for (std::size_t i = 0; i < 3 * LivePublisher::k_most_clients; ++i) silent.push_back(silent_client(place.path()));
  PlayerLink link(place.path());
  std::uint64_t seen = 0;
  ASSERT_FALSE(wait_for(link, seen, "playing").empty());
  expect_samples(publisher, link, seen, 10);
  for (const int connection : silent) ::close(connection);
}

TEST(Live, AFloodOfConnectionsHoldsUpNobody) {
  const Place place;
  LivePublisher publisher(place.path(), k_greeting);
  PlayerLink link(place.path());
  std::uint64_t seen = 0;
  wait_for(link, seen, "playing");
  std::atomic<bool> over{false};
  {
    std::vector<std::jthread> flood;
    for (int i = 0; i < 4; ++i)
      flood.emplace_back([&] {
        while (!over)
          if (const int connection = app::connect_live(place.path()); connection >= 0) ::close(connection);
      });
    expect_samples(publisher, link, seen, 10);
    over = true;
  }
}

TEST(Live, ATickMakesNoSystemCall) {
  LatestSlot<RecordRow> slot;
  const pid_t child = ::fork();
  if (child == 0) {
    // From here on any system call but exit is the end; whoever makes none can't be held up by a client.
    if (::prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) ::syscall(SYS_exit, 77);
    for (int i = 0; i < 10000; ++i) slot.store(row(i));
    ::syscall(SYS_exit, 0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << "no seccomp here";
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST(Live, TheSocketIsTheUsersAlone) {
  const Place place;
  const std::string path = place.path();
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

TEST(Live, TheFolderIsTheUsersAlone) {
  namespace fs = std::filesystem;
  const Place place;
  fs::create_directory(place.folder() / "shared");
  fs::create_directory_symlink(place.folder(), place.folder() / "link");
  std::ofstream(place.folder() / "file") << "a file";
  const auto refused_by_both = [](const fs::path& folder, const std::string& why) {
    for (const auto& start : {std::function<void()>([&] { LivePublisher((folder / "s").string(), k_greeting); }),
                              std::function<void()>([&] { PlayerLink((folder / "s").string()); })})
      try {
        start();
        ADD_FAILURE() << folder << " was taken";
      } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find(folder.string()), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
      }
  };
  refused_by_both(place.folder() / "link", "symbolic link");
  refused_by_both(place.folder() / "file", "no folder");
  refused_by_both(place.folder() / "none", "No such file");
  for (const mode_t mode : {0777U, 01777U, 0720U, 0702U}) {
    ::chmod((place.folder() / "shared").c_str(), mode);
    refused_by_both(place.folder() / "shared", "written by other users");
  }
  ::chmod((place.folder() / "shared").c_str(), 0755);
  EXPECT_NO_THROW(LivePublisher((place.folder() / "shared/s").string(), k_greeting));
  const fs::path of_another = ::geteuid() == 0 ? place.folder() / "shared" : fs::path("/usr");
  if (::geteuid() == 0) {
    EXPECT_EQ(::chown(of_another.c_str(), 65534, 65534), 0);
  }
  refused_by_both(of_another, "belongs to user");
}

TEST(Live, TheDefaultFolderIsMade) {
  namespace fs = std::filesystem;
  const Place place;
  const std::string elsewhere = "/tmp/papilla-" + std::to_string(::geteuid());
  ::setenv("XDG_RUNTIME_DIR", place.folder().c_str(), 1);
  const fs::path folder = place.folder() / "papilla";
  struct stat about {};
  for (const char* before : {"missing", "open"}) {
    EXPECT_EQ(app::default_live_socket(), folder / "player.sock") << before;
    ASSERT_EQ(::stat(folder.c_str(), &about), 0);
    EXPECT_EQ(about.st_mode & 07777, 0700U);
    ::chmod(folder.c_str(), 0755);
  }
  fs::remove(folder);
  fs::create_directory_symlink(place.folder(), folder);
  EXPECT_THROW(app::default_live_socket(), InvalidInput);
  ::chmod(place.folder().c_str(), 0770);  // Whoever may write there could exchange our folder.
  EXPECT_EQ(app::user_folder(), elsewhere);
  ::chmod(place.folder().c_str(), 0700);
  for (const char* other : {"", "relative", "/dev/null", "/no/such/folder"}) {
    ::setenv("XDG_RUNTIME_DIR", other, 1);
    EXPECT_EQ(app::user_folder(), elsewhere) << other;
  }
  ::unsetenv("XDG_RUNTIME_DIR");
  EXPECT_EQ(app::user_folder(), elsewhere);
}

TEST(Live, OtherUsersAreTurnedAwayOnBothSides) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can act as two users";
  const Place place;
  const std::string path = place.path();
  ::chmod(place.folder().c_str(), 0755);  // As if the folder did not keep them out.
  const sockaddr_un address = app::live_address(path);
  const auto connect = [&address] {
    const int connection = ::socket(AF_UNIX, SOCK_STREAM, 0);
    EXPECT_EQ(::connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    return connection;
  };
  {
    LivePublisher publisher(path, k_greeting);
    ::chmod(path.c_str(), 0666);
    char byte = 0;
    const int ours = connect();
    EXPECT_EQ(::recv(ours, &byte, 1, 0), 1);
    ::close(ours);
    EXPECT_EQ(as_another_user([&] { return ::recv(connect(), &byte, 1, 0) == 0 ? 0 : 1; }), 0) << "it got the greeting";
  }
  // A player is who called listen().
  const int listener = ::socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(as_another_user([&] { return ::listen(listener, 8); }), 0);
  ::close(connect());  // It does listen.
  EXPECT_EQ(app::connect_live(path), -1);
  ::close(listener);
}

}  // namespace
}  // namespace papilla
