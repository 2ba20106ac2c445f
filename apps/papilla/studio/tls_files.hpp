// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace papilla::app {

/// A certificate and its key, PEM files of a server that others in the network reach.
struct TlsFiles {
  std::string certificate, key;
  std::vector<std::string> names;  ///< Host names and addresses of the certificate, IPv6 in brackets; not empty.
};

/// Reads both.
/// @throws IoError naming the file that can't be read; InvalidInput when it is no certificate or no key without a
/// password, one is not the other's, the certificate has run out, or it names no host (subjectAltName).
TlsFiles read_tls_files(const std::string& certificate, const std::string& key);

}  // namespace papilla::app
