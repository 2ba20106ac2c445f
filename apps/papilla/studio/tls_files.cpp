// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/tls_files.hpp"

#include <arpa/inet.h>
#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

#include <memory>

#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"

namespace papilla::app {
namespace {

template <auto function>
struct Free {
  template <class T>
  void operator()(T* object) const noexcept {
    function(object);
  }
};
using Bio = std::unique_ptr<BIO, Free<BIO_free_all>>;
using Certificate = std::unique_ptr<X509, Free<X509_free>>;
using Key = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY_free>>;
using Names = std::unique_ptr<GENERAL_NAMES, Free<GENERAL_NAMES_free>>;

/// Nobody is asked for a password.
int no_password(char*, int, int, void*) noexcept { return 0; }

Bio memory_of(const std::string& text) { return Bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size()))); }

std::string text_of(const ASN1_STRING* text) {
  return {reinterpret_cast<const char*>(ASN1_STRING_get0_data(text)),
          static_cast<std::size_t>(ASN1_STRING_length(text))};
}

/// 4 or 16 bytes.
std::string address_of(const std::string& bytes) {
  char text[INET6_ADDRSTRLEN] = {};
  constexpr std::size_t k_v4 = 4, k_v6 = 16;
  if (bytes.size() == k_v4 && ::inet_ntop(AF_INET, bytes.data(), text, sizeof text) != nullptr) return text;
  if (bytes.size() == k_v6 && ::inet_ntop(AF_INET6, bytes.data(), text, sizeof text) != nullptr)
    return "[" + std::string(text) + "]";
  return {};
}

/// Without patterns, which are no place that a browser could be sent to.
std::vector<std::string> names_of(const X509& certificate) {
  std::vector<std::string> names;
  const Names list(static_cast<GENERAL_NAMES*>(X509_get_ext_d2i(&certificate, NID_subject_alt_name, nullptr, nullptr)));
  for (int i = 0; list && i < sk_GENERAL_NAME_num(list.get()); ++i) {
    const GENERAL_NAME* name = sk_GENERAL_NAME_value(list.get(), i);
    std::string text;
    if (name->type == GEN_DNS) text = text_of(name->d.dNSName);
    if (name->type == GEN_IPADD) text = address_of(text_of(name->d.iPAddress));
    if (!text.empty() && text.find_first_of("*/ \"'<>\\") == std::string::npos) names.push_back(std::move(text));
  }
  return names;
}

}  // namespace

TlsFiles read_tls_files(const std::string& certificate_file, const std::string& key_file) {
  const std::string certificate_text = read_file(certificate_file), key_text = read_file(key_file);
  const Certificate certificate(PEM_read_bio_X509(memory_of(certificate_text).get(), nullptr, no_password, nullptr));
  if (!certificate) throw InvalidInput(certificate_file + ": is no certificate in PEM");
  const Key key(PEM_read_bio_PrivateKey(memory_of(key_text).get(), nullptr, no_password, nullptr));
  if (!key) throw InvalidInput(key_file + ": is no private key in PEM without a password");
  if (X509_check_private_key(certificate.get(), key.get()) != 1)
    throw InvalidInput(key_file + ": is not the key of " + certificate_file);
  if (X509_cmp_current_time(X509_get0_notAfter(certificate.get())) < 0)
    throw InvalidInput(certificate_file + ": has run out");
  TlsFiles files{certificate_file, key_file, names_of(*certificate)};
  if (files.names.empty()) throw InvalidInput(certificate_file + ": names no host (subjectAltName)");
  return files;
}

}  // namespace papilla::app
