// SPDX-License-Identifier: MIT
// The first process of a virtual machine: creates fake force devices with /dev/uhid, runs /player on /plate.glb with
// them through hidapi and the kernel's HID layer, and checks what they received. The last line is "guest: all passed"
// on success.
#include <fcntl.h>
#include <linux/reboot.h>
#include <linux/uhid.h>
#include <poll.h>
#include <sys/mount.h>
#include <sys/reboot.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <mutex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "haptic/hid_shapes.hpp"

namespace {

using Bytes = std::vector<std::uint8_t>;
using std::chrono::milliseconds;

int failures = 0;

void expect(bool holds, const std::string& what) {
  std::printf("guest: %s %s\n", holds ? "ok  " : "FAIL", what.c_str());
  failures += !holds;
}

/// A device of /dev/uhid: sends positions at 1 kHz and records the reports it receives.
class Device {
 public:
  enum class Kind { pid, force_report };

  explicit Device(Kind kind) : kind_(kind), file_(::open("/dev/uhid", O_RDWR | O_CLOEXEC)) {
    const auto descriptor =
        kind == Kind::pid ? papilla::testing::pid_descriptor() : papilla::testing::force_report_descriptor();
    uhid_event event{};
    event.type = UHID_CREATE2;
    std::snprintf(reinterpret_cast<char*>(event.u.create2.name), sizeof event.u.create2.name, "fake force device");
    std::memcpy(&event.u.create2.rd_data, descriptor.data(), descriptor.size());
    event.u.create2.rd_size = static_cast<std::uint16_t>(descriptor.size());
    event.u.create2.bus = 3;  // USB.
    event.u.create2.vendor = 0x1209;
    event.u.create2.product = kind == Kind::pid ? 1 : 2;
    send(event);
    receiver_ = std::thread([this] { receive(); });
    hand_ = std::thread([this] { move(); });
    std::this_thread::sleep_for(milliseconds(300));
  }
  ~Device() {
    ending_ = true;
    hand_.join();
    receiver_.join();
    if (file_ >= 0) ::close(file_);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  void unplug() {
    uhid_event event{};
    event.type = UHID_DESTROY;
    unplugged_ = true;
    send(event);
  }

  std::vector<Bytes> told() {
    const std::lock_guard lock(mutex_);
    return told_;
  }
  bool wait_for_force(int tenths) {
    for (int i = 0; i < tenths; ++i) {
      if (largest_magnitude() > 0) return true;
      std::this_thread::sleep_for(milliseconds(100));
    }
    return false;
  }
  /// Largest force so far, in counts.
  int largest_magnitude() {
    int largest = 0;
    for (const Bytes& r : told())
      for (std::size_t at : force_places(r)) largest = std::max(largest, std::abs(number(r, at)));
    return largest;
  }
  /// Whether the last reports are zero force on every axis and actuators off.
  bool is_off() {
    const std::vector<Bytes> all = told();
    if (all.empty()) return false;
    const Bytes& last = all.back();
    if (kind_ == Kind::force_report)
      return last.size() == 11 && std::all_of(last.begin() + 1, last.end() - 1, [](std::uint8_t b) { return b == 0; });
    if (last != Bytes{10, 2}) return false;  // Device Control: disable is the second of the codes.
    for (const int block : {1, 2, 3}) {
      const auto newest =
          std::find_if(all.rbegin(), all.rend(), [&](const Bytes& r) { return r[0] == 7 && r[1] == block; });
      if (newest == all.rend() || number(*newest, 2) != 0) return false;
    }
    return true;
  }

 private:
  std::vector<std::size_t> force_places(const Bytes& r) const {
    if (kind_ == Kind::pid)
      return r[0] == 7 && r.size() >= 4 ? std::vector<std::size_t>{2} : std::vector<std::size_t>{};
    return r[0] == 1 && r.size() >= 11 ? std::vector<std::size_t>{3, 5, 7} : std::vector<std::size_t>{};
  }
  static int number(const Bytes& r, std::size_t at) { return static_cast<std::int16_t>(r[at] + 256 * r[at + 1]); }

  void send(const uhid_event& event) {
    const std::lock_guard lock(write_mutex_);
    if (::write(file_, &event, sizeof event) < 0) std::perror("uhid");
  }

  void receive() {
    while (!ending_) {
      pollfd waiting{file_, POLLIN, 0};
      uhid_event event{};
      if (::poll(&waiting, 1, 50) <= 0 || ::read(file_, &event, sizeof event) <= 0) continue;
      if (event.type == UHID_OUTPUT) {
        const std::lock_guard lock(mutex_);
        Bytes report(event.u.output.size);
        std::memcpy(report.data(), &event.u.output.data, report.size());
        told_.push_back(std::move(report));
      } else if (event.type == UHID_SET_REPORT) {
        uhid_event reply{};
        reply.type = UHID_SET_REPORT_REPLY;
        reply.u.set_report_reply.id = event.u.set_report.id;
        send(reply);
      } else if (event.type == UHID_GET_REPORT) {
        uhid_event reply{};
        reply.type = UHID_GET_REPORT_REPLY;
        reply.u.get_report_reply.id = event.u.get_report.id;
        const Bytes answer = kind_ == Kind::pid ? Bytes{12, static_cast<std::uint8_t>(++blocks_), 1}
                                                : Bytes{3,  1, 0,    0xE8, 3,   0xA0, 0x0F, 0x10, 0x27, 0, 0,    80, 0,
                                                        50, 0, 0xBC, 2,    200, 0,    0x30, 0x75, 0,    0, 0xF4, 1};
        std::memcpy(&reply.u.get_report_reply.data, answer.data(), answer.size());
        reply.u.get_report_reply.size = static_cast<std::uint16_t>(answer.size());
        send(reply);
      }
    }
  }

  /// Down along y by 13 mm in two seconds, then at rest with a tremor.
  void move() {
    for (int frame = 0; !ending_ && !unplugged_; ++frame) {
      std::this_thread::sleep_for(milliseconds(1));
      const double y = -0.013 * std::min(1.0, frame / 2000.0);
      Bytes r;
      if (kind_ == Kind::pid) {
        const int counts = static_cast<int>(y / 0.075 * 32767);
        r = {5, 0, 0, static_cast<std::uint8_t>(counts & 0xff), static_cast<std::uint8_t>(counts >> 8 & 0xff), 0, 0, 0};
      } else {
        const int counts = static_cast<int>(y / 10e-6);
        r = Bytes(21);
        r[0] = 2;
        r[1] = static_cast<std::uint8_t>(frame & 0xff);
        r[2] = static_cast<std::uint8_t>(frame >> 8 & 0xff);
        for (std::size_t i = 0; i < 4; ++i) r[11 + i] = static_cast<std::uint8_t>(counts >> (8 * i) & 0xff);
      }
      uhid_event event{};
      event.type = UHID_INPUT2;
      event.u.input2.size = static_cast<std::uint16_t>(r.size());
      std::memcpy(&event.u.input2.data, r.data(), r.size());
      send(event);
    }
  }

  Kind kind_;
  int file_, blocks_ = 0;
  std::mutex mutex_, write_mutex_;
  std::vector<Bytes> told_;
  std::atomic<bool> ending_{false}, unplugged_{false};
  std::thread receiver_, hand_;
};

pid_t start_player(const std::vector<std::string>& arguments) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  ::setpgid(0, 0);
  std::vector<std::string> all = {"/player", "/plate.glb", "--origin", "0.05,0.01,-0.05", "--watchdog", "1000", "-q"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& text : all) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  ::execv(pointers[0], pointers.data());
  ::_exit(127);
}

int exit_code(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

std::string slurp(const char* path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

void plays(Device::Kind kind, const std::string& name) {
  Device device(kind);
  const std::string id = kind == Device::Kind::pid ? "hid:1209:0001" : "hid:1209:0002";
  expect(exit_code(start_player({"--device", id, "--seconds", "3", "--json", "/r.json"})) == 0, name + " plays");
  const std::string report = slurp("/r.json");
  expect(device.largest_magnitude() > 100, name + " feels a force");
  expect(device.is_off(), name + " is off at the end");
  expect(report.find("\"lost_contact_ticks\": 0") != std::string::npos, name + " never loses contact");
  expect(report.find("\"contact_ticks\": 0,") == std::string::npos, name + " is in contact");
}

void unplugged(Device::Kind kind, const std::string& name) {
  Device device(kind);
  const pid_t player = start_player({"--device", "hid", "--seconds", "60"});
  expect(device.wait_for_force(100), name + " pushes before it is unplugged");
  device.unplug();
  expect(exit_code(player) == 5, name + ", unplugged, is exit code 5");
}

void killed(Device::Kind kind, int signal, const std::string& name) {
  Device device(kind);
  const pid_t player = start_player({"--device", "hid", "--seconds", "60"});
  expect(device.wait_for_force(100), name + " pushes before the signal");
  ::kill(player, signal);
  expect(exit_code(player) == (signal == SIGKILL ? -SIGKILL : 5), name + ": how it ended");
  for (int i = 0; i < 100 && !device.is_off(); ++i) std::this_thread::sleep_for(milliseconds(20));
  expect(device.is_off(), name + ": the device is off");
}

void load_module(const char* path) {
  const int file = ::open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) return;  // Built into the kernel.
  if (::syscall(SYS_finit_module, file, "", 0) != 0) std::perror(path);
  ::close(file);
}

void run_all() {
  ::mkdir("/proc", 0755);
  ::mkdir("/sys", 0755);
  ::mkdir("/dev", 0755);
  ::mkdir("/tmp", 0755);
  ::mount("proc", "/proc", "proc", 0, nullptr);
  ::mount("sysfs", "/sys", "sysfs", 0, nullptr);
  ::mount("devtmpfs", "/dev", "devtmpfs", 0, nullptr);
  for (const char* module : {"/hid.ko", "/hid-generic.ko", "/uhid.ko"}) load_module(module);
  {
    const Device device(Device::Kind::pid);
    const pid_t child = ::fork();
    if (child == 0) {
      ::execl("/player", "/player", "--list-devices", "-q", "--json", "/list.json", nullptr);
      ::_exit(127);
    }
    exit_code(child);
    expect(slurp("/list.json").find("HID PID, 3 axes") != std::string::npos, "--list-devices names the PID device");
  }
  plays(Device::Kind::pid, "PID");
  plays(Device::Kind::force_report, "force report");
  unplugged(Device::Kind::pid, "PID");
  killed(Device::Kind::pid, SIGKILL, "PID, SIGKILL");
  killed(Device::Kind::pid, SIGTERM, "PID, SIGTERM");
  killed(Device::Kind::force_report, SIGINT, "force report, SIGINT");
}

}  // namespace

int main() {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  run_all();
  std::printf("guest: %s\n", failures == 0 ? "all passed" : "FAILED");
  std::fflush(stdout);
  ::sync();
  ::reboot(LINUX_REBOOT_CMD_POWER_OFF);
}
