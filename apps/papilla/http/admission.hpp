// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <vector>

namespace papilla::app {

/// What of a request tells whether it is served. Of each field all values.
struct RequestHead {
  std::string target;  ///< Path and query.
  std::vector<std::string> hosts, origins, referers;
};

/// Whom a server on 127.0.0.1 serves: who has its token, which stands in the query, names it by one Host field, and
/// comes from one of its pages where Origin and Referer are given.
class Admission {
 public:
  /// @param port of this server. @param page_port of the server whose pages ask; 0: the same.
  Admission(int port, std::string token, int page_port = 0);

  bool admits(const RequestHead& request) const;

  /// http://127.0.0.1:PORT/?token=TOKEN
  std::string url() const { return "http://" + hosts_[0] + "/?token=" + token_; }
  const std::string& token() const noexcept { return token_; }

 private:
  std::string token_;
  std::array<std::string, 3> hosts_, page_hosts_;
};

/// The Content-Security-Policy of pages: nothing from elsewhere, in no frame.
/// @param connect what else than its own server a page may ask, such as "ws://127.0.0.1:1234"; or empty.
std::string page_policy(const std::string& connect = {});

}  // namespace papilla::app
