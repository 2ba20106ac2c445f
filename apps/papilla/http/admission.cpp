// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/admission.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace papilla::app {
namespace {

/// Takes the same time for every text of this length.
bool equal_in_constant_time(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  volatile unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference = difference | (static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  return difference == 0;
}

/// The value of a query's first `token`.
std::string_view token_of(std::string_view query) {
  constexpr std::string_view k_name = "token=";
  while (!query.empty()) {
    const std::string_view pair = query.substr(0, query.find('&'));
    if (pair.starts_with(k_name)) return pair.substr(k_name.size());
    query.remove_prefix(std::min(pair.size() + 1, query.size()));
  }
  return {};
}

std::vector<std::string> hosts_of(int port, const ServedNames& names) {
  const int usual = names.scheme == "https" ? 443 : 80;  // Browsers leave it out.
  std::vector<std::string> hosts = names.hosts;
  if (port != usual)
    for (std::string& host : hosts) host += ":" + std::to_string(port);
  return hosts;
}

}  // namespace

Admission::Admission(int port, std::string token, int page_port, const ServedNames& names)
    : token_(std::move(token)),
      scheme_(names.scheme),
      hosts_(hosts_of(port, names)),
      page_hosts_(hosts_of(page_port != 0 ? page_port : port, names)) {}

bool Admission::admits(const RequestHead& request) const {
  const std::string_view target = request.target;
  const std::size_t query = target.find('?');
  const bool known =
      query != std::string_view::npos && equal_in_constant_time(token_of(target.substr(query + 1)), token_);
  if (request.hosts.size() != 1) return false;
  const auto host = std::find(hosts_.begin(), hosts_.end(), request.hosts.front());
  if (host == hosts_.end()) return false;
  const std::string page = scheme_ + "://" + page_hosts_[static_cast<std::size_t>(host - hosts_.begin())];
  return known &&
         std::all_of(request.origins.begin(), request.origins.end(),
                     [&](const auto& value) { return value == page; }) &&
         std::all_of(request.referers.begin(), request.referers.end(),
                     [&](const std::string& value) { return value.starts_with(page + "/"); });
}

std::string page_policy(const std::string& connect) {
  return "default-src 'none'; script-src 'self' 'unsafe-inline' 'wasm-unsafe-eval'; style-src 'self' 'unsafe-inline'; "
         "img-src 'self' data: blob:; connect-src 'self'" +
         (connect.empty() ? "" : " " + connect) + "; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
}

}  // namespace papilla::app
