// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_network.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace papilla::app {

ServedNames served_names(const std::optional<TlsFiles>& tls) {
  ServedNames served;
  if (!tls) return served;
  served.scheme = "https";
  std::vector<std::string> hosts = tls->names;
  for (const std::string& own : served.hosts)
    if (std::find(hosts.begin(), hosts.end(), own) == hosts.end()) hosts.push_back(own);
  served.hosts = std::move(hosts);
  return served;
}

std::string socket_sources(const ServedNames& names, int port) {
  std::string sources;
  for (const std::string& host : names.hosts)
    if (host.front() != '[')  // A Content-Security-Policy has no IPv6 addresses.
      sources += (sources.empty() ? "" : " ") + std::string(names.scheme == "https" ? "wss" : "ws") + "://" + host +
                 ":" + std::to_string(port);
  return sources;
}

}  // namespace papilla::app
