// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/page_server.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <filesystem>
#include <stdexcept>
#include <thread>
#include <vector>

#include "papilla/core/error.hpp"

namespace papilla::app {
namespace {

using namespace std::chrono_literals;

constexpr int k_patience_ms = 120000;  // A hang ends the test; how long a step takes is the machine's affair.

/// A connection to 127.0.0.1 that sends and reads bytes as they are.
class Client {
 public:
  explicit Client(int port, const char* host = "127.0.0.1")
      : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    ::inet_pton(AF_INET, host, &address.sin_addr);
    connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  Client(Client&& other) noexcept : socket_(std::exchange(other.socket_, -1)), connected_(other.connected_) {}
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  Client& operator=(Client&&) = delete;
  ~Client() {
    if (socket_ >= 0) ::close(socket_);
  }

  bool connected() const { return connected_; }
  /// @returns false when the other end is gone.
  bool send(const std::string& text) const {
    for (std::size_t at = 0; at < text.size();) {
      const ssize_t sent = ::send(socket_, text.data() + at, text.size() - at, MSG_NOSIGNAL);
      if (sent <= 0) return false;
      at += static_cast<std::size_t>(sent);
    }
    return true;
  }
  /// What comes next; empty at the end.
  std::string read_some() const {
    pollfd waiting{socket_, POLLIN, 0};
    if (::poll(&waiting, 1, k_patience_ms) <= 0) {
      ADD_FAILURE() << "the server neither answers nor closes";
      return {};
    }
    std::string text(65536, '\0');
    const ssize_t got = ::recv(socket_, text.data(), text.size(), 0);
    text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    return text;
  }
  std::string read_all() const {
    std::string all;
    for (std::string text = read_some(); !text.empty(); text = read_some()) all += text;
    return all;
  }
  /// Reads until `part` came `count` times. @returns false when the stream ends before.
  bool read_times(const std::string& part, int count) const {
    std::string rest;
    while (count > 0) {
      const std::string text = read_some();
      if (text.empty()) return false;
      rest += text;
      for (std::size_t at = rest.find(part); at != std::string::npos; at = rest.find(part)) {
        rest.erase(0, at + part.size());
        --count;
      }
    }
    return true;
  }

 private:
  int socket_;
  bool connected_ = false;
};

/// Host, port and token of a server's address.
struct Address {
  explicit Address(const PageServer& server)
      : host(server.url().substr(7, server.url().find('/', 7) - 7)),
        port(std::stoi(host.substr(host.find(':') + 1))),
        token(server.url().substr(server.url().find('=') + 1)) {}

  std::string get(const std::string& path, const std::string& more = {}) const {
    return "GET " + path + "?token=" + token + " HTTP/1.1\r\nHost: " + host + "\r\n" + more + "\r\n";
  }
  std::string post(const std::string& path, const std::string& more) const {
    return "POST " + path + "?token=" + token + " HTTP/1.1\r\nHost: " + host + "\r\n" + more + "\r\n";
  }
  std::string ask(const std::string& request) const {
    const Client client(port);
    client.send(request);
    return client.read_all();
  }
  int status(const std::string& request) const {
    const std::string answer = ask(request);
    return answer.starts_with("HTTP/1.1 ") ? std::stoi(answer.substr(9)) : 0;
  }

  std::string host;
  int port;
  std::string token;
};

SharedText text_of(std::string text) { return std::make_shared<const std::string>(std::move(text)); }

PageRoutes routes_of_test() {
  PageRoutes routes;
  routes.get["/"] = [] { return PageAnswer{200, "text/html; charset=utf-8", text_of("the page")}; };
  routes.get["/broken"] = []() -> PageAnswer { throw std::runtime_error("secret"); };
  routes.post["/length"] = [](const std::string& body) {
    return PageAnswer{200, "text/plain", text_of(std::to_string(body.size()))};
  };
  routes.streams["/live"] = [](std::uint64_t& seen) { return "data: " + std::to_string(++seen) + "\n\n"; };
  return routes;
}

TEST(PageServer, OnlyTheTokenOpens) {
  const PageServer server(routes_of_test(), 0), other(routes_of_test(), 0);
  const Address at(server);
  EXPECT_EQ(at.token.size(), 32U);
  EXPECT_NE(at.token, Address(other).token);
  EXPECT_NE(at.ask(at.get("/")).find("\r\n\r\nthe page"), std::string::npos);

  const auto bare = [&](const std::string& target) {
    return "GET " + target + " HTTP/1.1\r\nHost: " + at.host + "\r\n\r\n";
  };
  const std::string refused = at.ask(bare("/"));
  EXPECT_TRUE(refused.starts_with("HTTP/1.1 403 ")) << refused;
  EXPECT_TRUE(refused.ends_with("\r\n\r\n")) << refused;  // No body.
  std::string wrong = at.token;
  wrong.back() = wrong.back() == '0' ? '1' : '0';
  for (const std::string& target :
       {std::string("/live"), std::string("/broken"), std::string("/none"), std::string("*"), std::string("/?token="),
        "/?token=" + wrong, "/?token=" + at.token.substr(1), "/?token=" + at.token + "0", "/?Token=" + at.token,
        "/?other=" + at.token, "/" + at.token, "/?token=" + Address(other).token})
    EXPECT_EQ(at.ask(bare(target)), refused) << target;  // Byte for byte: nobody learns what there is.
  EXPECT_EQ(at.status(bare("/?a=b&token=" + at.token)), 200);
  EXPECT_EQ(at.status(at.get("/none")), 404);
  EXPECT_EQ(at.status(at.get("/length")), 404);
  EXPECT_EQ(at.ask(at.get("/broken")).find("secret"), std::string::npos);
  EXPECT_EQ(at.status(at.get("/broken")), 500);
}

TEST(PageServer, OtherHostsAndOriginsAreRefused) {
  const PageServer server(routes_of_test(), 0);
  const Address at(server);
  const std::string port = ":" + std::to_string(at.port), line = "GET /?token=" + at.token + " HTTP/1.1\r\n";
  for (const std::string& host : {"127.0.0.1" + port, "localhost" + port, "[::1]" + port}) {
    EXPECT_EQ(at.status(line + "Host: " + host + "\r\n\r\n"), 200) << host;
    EXPECT_EQ(at.status(line + "Host: " + host + "\r\nOrigin: http://" + host + "\r\n\r\n"), 200) << host;
    EXPECT_EQ(at.status(line + "Host: " + host + "\r\nReferer: http://" + host + "/\r\n\r\n"), 200) << host;
  }
  EXPECT_EQ(at.status(line + "\r\n"), 403);
  EXPECT_EQ(at.status(line + "Host: " + at.host + "\r\nHost: " + at.host + "\r\n\r\n"), 403);
  for (const std::string& host : {std::string("example.com"), "example.com" + port, std::string("127.0.0.1"),
                                  "127.0.0.1" + port + "0", "127.0.0.1.example.com" + port, "127.0.0.2" + port})
    EXPECT_EQ(at.status(line + "Host: " + host + "\r\n\r\n"), 403) << host;
  for (const std::string& field :
       {std::string("Origin: null"), std::string("Origin: http://example.com"), "Origin: https://" + at.host,
        std::string("Origin: http://127.0.0.1:1"), std::string("Referer: http://example.com/"),
        "Referer: http://" + at.host + ".example.com/", "Origin: http://" + at.host + "\r\nOrigin: null"})
    EXPECT_EQ(at.status(at.get("/", field + "\r\n")), 403) << field;
}

TEST(PageServer, OnlyThisMachineAndNoChild) {
  const PageServer server(routes_of_test(), 0);
  const Address at(server);
  const Client open(at.port);
  open.send(at.get("/live"));
  ASSERT_TRUE(open.read_times("data: ", 1));
  EXPECT_FALSE(Client(at.port, "127.0.0.2").connected());
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    const int file = std::stoi(entry.path().filename().string());
    std::error_code gone;
    if (!std::filesystem::read_symlink(entry.path(), gone).string().starts_with("socket:")) continue;
    EXPECT_NE(::fcntl(file, F_GETFD) & FD_CLOEXEC, 0) << "a browser that is started would keep socket " << file;
  }
  EXPECT_THROW(PageServer(routes_of_test(), at.port), IoError);
}

TEST(PageServer, EveryAnswerForbidsWhatPagesNeedNot) {
  const PageServer server(routes_of_test(), 0);
  const Address at(server);
  const Client stream(at.port);
  stream.send(at.get("/live"));
  for (const std::string& answer : {at.ask(at.get("/")), at.ask("GET / HTTP/1.1\r\n\r\n"), stream.read_some()})
    for (const char* field :
         {"X-Content-Type-Options: nosniff\r\n", "Referrer-Policy: no-referrer\r\n", "frame-ancestors 'none'",
          "default-src 'none'", "Cache-Control: no-store\r\n", "Cross-Origin-Resource-Policy: same-origin\r\n"})
      EXPECT_NE(answer.find(field), std::string::npos) << field << answer;
}

TEST(PageServer, LargeBodiesAreRefusedUnread) {
  const PageServer server(routes_of_test(), 0);
  const Address at(server);
  const std::string most(65536, 'x');
  EXPECT_TRUE(at.ask(at.post("/length", "Content-Length: 65536\r\n") + most).ends_with("\r\n\r\n65536"));
  EXPECT_TRUE(at.ask(at.post("/length", "Transfer-Encoding: chunked\r\n") + "10000\r\n" + most + "\r\n0\r\n\r\n")
                  .ends_with("\r\n\r\n65536"));
  EXPECT_TRUE(at.ask(at.post("/length", "Content-Length: 0\r\n")).ends_with("\r\n\r\n0"));

  // Nothing of the body was sent when the answer comes.
  for (const char* length : {"65537", "99999999999", "18446744073709551615"}) {
    const Client client(at.port);
    client.send(at.post("/length", std::string("Content-Length: ") + length + "\r\n"));
    EXPECT_TRUE(client.read_some().starts_with("HTTP/1.1 413 ")) << length;
  }
  EXPECT_EQ(at.status(at.post("/length", "Transfer-Encoding: chunked\r\n") + "10001\r\n"), 413);
  EXPECT_EQ(at.status(at.post("/length", "Transfer-Encoding: chunked\r\n") + "8000\r\n" + most.substr(0, 0x8000) +
                      "\r\n8001\r\n"),
            413);
  // Who sends it all the same still gets the answer.
  EXPECT_EQ(at.status(at.post("/length", "Content-Length: 8000000\r\n") + std::string(8000000, 'x')), 413);
  EXPECT_EQ(at.status("POST /length HTTP/1.1\r\nHost: " + at.host + "\r\nContent-Length: 99999999999\r\n\r\n"), 403);
}

TEST(PageServer, WhatIsNoRequestIsRefused) {
  const PageServer server(routes_of_test(), 0);
  const Address at(server);
  for (const std::string& garbage :
       {std::string("\r\n\r\n\r\n"), std::string("GET\r\n\r\n"), std::string("\x16\x03\x01\x02\x00\x01", 6),
        "GET / HTTP/9.9\r\n\r\n" + std::string(), at.get("/", "Content-Length: -1\r\n"),
        at.get("/", "Content-Length: 1\r\nTransfer-Encoding: chunked\r\n"), "GET /" + std::string(20000, 'a'),
        at.get("/", "Cookie: " + std::string(20000, 'a') + "\r\n")})
    EXPECT_EQ(at.status(garbage), 400) << garbage.substr(0, 80);
  EXPECT_EQ(at.status(at.get("/", "Cookie: " + std::string(12000, 'a') + "\r\n")), 200);
  EXPECT_EQ(at.status("DELETE" + at.get("/").substr(3)), 405);
  EXPECT_EQ(at.status(at.get("/")), 200);
}

TEST(PageServer, ThousandsWhoWaitHoldUpNobody) {
  constexpr std::size_t k_of_a_kind = 1000;
  rlimit files{};
  ::getrlimit(RLIMIT_NOFILE, &files);
  if (files.rlim_max < 8000) GTEST_SKIP() << "the system lets a process have " << files.rlim_max << " files only";
  files.rlim_cur = std::max<rlim_t>(files.rlim_cur, 8000);
  ::setrlimit(RLIMIT_NOFILE, &files);

  const PageServer server(routes_of_test(), 0);
  const Address at(server);
  const Client early(at.port);
  early.send(at.get("/live"));
  ASSERT_TRUE(early.read_times("data: ", 1));

  std::vector<Client> silent, drip, deaf;
  for (std::size_t i = 0; i < k_of_a_kind; ++i) {
    silent.emplace_back(at.port);
    drip.emplace_back(at.port);
    deaf.emplace_back(at.port).send(at.get("/live"));
  }
  std::atomic<bool> over{false};
  std::jthread dripping([&] {  // A request that never ends, byte by byte.
    const std::string begin = at.get("/").substr(0, at.get("/").size() - 2) + "X: ";
    for (std::size_t i = 0; !over; ++i) {
      for (const Client& client : drip) client.send(i < begin.size() ? begin.substr(i, 1) : "x");
      std::this_thread::sleep_for(200ms);
    }
  });
  EXPECT_TRUE(early.read_times("data: ", 30));
  const Client late(at.port);
  late.send(at.get("/live"));
  EXPECT_TRUE(late.read_times("data: ", 30));
  for (int i = 0; i < 10; ++i) EXPECT_EQ(at.status(at.get("/")), 200);
  over = true;
}

TEST(PageServer, WhoIsTooSlowIsDropped) {
  PageLimits limits;
  limits.request = limits.stall = 300ms;
  PageRoutes routes = routes_of_test();
  std::atomic<std::uint64_t> asked{0};
  routes.streams["/large"] = [&](std::uint64_t& seen) {
    ++asked;
    return "data: " + std::to_string(++seen) + std::string(1U << 20U, 'x') + "\n\n";
  };
  routes.get["/large"] = [] { return PageAnswer{200, "text/plain", text_of(std::string(64U << 20U, 'x'))}; };
  const PageServer server(std::move(routes), 0, limits);
  const Address at(server);
  EXPECT_EQ(Client(at.port).read_all(), "");  // Silent.
  const Client drip(at.port);
  while (drip.send("G")) std::this_thread::sleep_for(20ms);
  const Client body(at.port);
  body.send(at.post("/length", "Content-Length: 50\r\n"));
  while (body.send("x")) std::this_thread::sleep_for(100ms);  // They would all be there after 5 s.
  EXPECT_EQ(body.read_all(), "");

  const Client page(at.port);
  page.send(at.get("/large"));
  std::this_thread::sleep_for(2s);
  EXPECT_LT(page.read_all().size(), 64U << 20U);

  // A stream that nobody reads is asked for no more than what waits in the system, and ends.
  const Client deaf(at.port);
  deaf.send(at.get("/large"));
  std::this_thread::sleep_for(2s);
  EXPECT_LT(asked, 30U);
  deaf.read_all();
}

TEST(PageServer, AboveTheLimits) {
  PageLimits limits;
  limits.clients = 2;
  limits.strangers = 3;
  const PageServer server(routes_of_test(), 0, limits);
  const Address at(server);
  const Client one(at.port);
  {
    const Client two(at.port);
    for (const Client* client : {&one, &two}) {
      client->send(at.get("/live"));
      ASSERT_TRUE(client->read_times("data: ", 1));
    }
    EXPECT_EQ(at.status(at.get("/")), 503);
    EXPECT_EQ(at.status("GET / HTTP/1.1\r\n\r\n"), 403);
  }
  while (at.status(at.get("/")) == 503) std::this_thread::sleep_for(10ms);  // Until the server sees that `two` is gone.
  EXPECT_EQ(at.status(at.get("/")), 200);
  EXPECT_TRUE(one.read_times("data: ", 3));

  std::vector<Client> strangers;
  for (int i = 0; i < 3; ++i) strangers.emplace_back(at.port);
  EXPECT_EQ(at.status(at.get("/")), 200);       // The fourth,
  EXPECT_EQ(strangers.front().read_all(), "");  // for whom the first had to go.
  strangers.back().send(at.get("/"));
  EXPECT_TRUE(strangers.back().read_all().starts_with("HTTP/1.1 200 "));
}

TEST(PageServer, EndsWithClientsOfAllKinds) {
  std::vector<Client> clients;
  {
    const PageServer server(routes_of_test(), 0);
    const Address at(server);
    for (int i = 0; i < 12; ++i) {
      clients.emplace_back(at.port);
      if (i % 4 > 0) clients.back().send(i % 4 == 1 ? "GET " : i % 4 == 2 ? at.get("/live") : at.get("/"));
    }
  }
  for (const Client& client : clients) client.read_all();
}

}  // namespace
}  // namespace papilla::app
