// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace papilla::app {

/// What of a request tells whether it is served. Of each field all values.
struct RequestHead {
  std::string target;  ///< Path and query.
  std::vector<std::string> hosts, origins, referers;
};

/// How browsers reach a server.
struct ServedNames {
  std::string scheme = "http";
  std::vector<std::string> hosts = {"127.0.0.1", "localhost", "[::1]"};  ///< Without port.
};

/// Whom a server serves: who has its token, which stands in the query, names it by one Host field that is one of its
/// names, and comes from one of its pages where Origin and Referer are given.
class Admission {
 public:
  /// @param port of this server. @param page_port of the server whose pages ask; 0: the same. @pre a host or more.
  Admission(int port, std::string token, int page_port = 0, const ServedNames& names = {});

  bool admits(const RequestHead& request) const;

  /// http://127.0.0.1:PORT/?token=TOKEN; of the first host.
  std::string url() const { return scheme_ + "://" + hosts_[0] + "/?token=" + token_; }
  const std::string& token() const noexcept { return token_; }

 private:
  std::string token_, scheme_;
  std::vector<std::string> hosts_, page_hosts_;
};

/// The Content-Security-Policy of pages: nothing from elsewhere, in no frame.
/// @param connect what else than its own server a page may ask, such as "ws://127.0.0.1:1234"; or empty.
std::string page_policy(const std::string& connect = {});

}  // namespace papilla::app
