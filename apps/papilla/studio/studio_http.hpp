// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "http/admission.hpp"
#include "http/page_server.hpp"
#include "studio/tls_files.hpp"

namespace papilla::app {

/// A query's names and values, decoded.
using Query = std::map<std::string, std::string>;

/// Gives a body piece by piece to `take`, which ends it by false. @returns whether it came whole.
using BodySource = std::function<bool(const std::function<bool(std::string_view)>& take)>;

/// What a studio serves, by path. Each request runs in a thread of its own, so that functions may take long. What they
/// throw becomes {"error": …} with status 409.
struct StudioRoutes {
  std::map<std::string, std::function<PageAnswer(const Query&)>> get;
  /// With a body of at most 1 MiB; 413 above.
  std::map<std::string, std::function<PageAnswer(const Query&, const std::string& body)>> post;
  std::map<std::string, std::function<PageAnswer(const Query&, const BodySource& body)>> uploads;
};

/// An HTTP server for the studio's pages on 127.0.0.1, or an HTTPS server on every address of this machine, by the
/// rules of Admission: 403 and nothing else for everybody else. Unlike PageServer it takes bodies as they come and lets
/// answers take their time.
class StudioHttp {
 public:
  static constexpr std::size_t k_most_body_bytes = std::size_t{1} << 20;

  /// @param port 0 takes any that is free. @param tls of the HTTPS server. @throws IoError when the port is taken.
  explicit StudioHttp(int port, const std::optional<TlsFiles>& tls = {});
  ~StudioHttp();  ///< Ends when all requests have.
  StudioHttp(const StudioHttp&) = delete;
  StudioHttp& operator=(const StudioHttp&) = delete;

  int port() const noexcept { return port_; }
  /// Begins to serve, in threads of its own. Once.
  /// @param connect as page_policy() has it.
  void start(StudioRoutes routes, const Admission& admission, const std::string& connect);

 private:
  class Server;
  std::unique_ptr<Server> server_;
  int port_ = 0;
};

}  // namespace papilla::app
