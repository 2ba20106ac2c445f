// SPDX-License-Identifier: MIT
#include "papilla/cache/digest.hpp"

#include <openssl/evp.h>

#include <new>

#include "papilla/core/error.hpp"
#include "papilla/core/hex.hpp"

namespace papilla {

struct Sha256::State {
  State() : context(EVP_MD_CTX_new()) {
    if (context == nullptr) throw std::bad_alloc();
    if (EVP_DigestInit_ex(context, EVP_sha256(), nullptr) != 1) throw Error("the library OpenSSL has no SHA-256");
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { EVP_MD_CTX_free(context); }

  EVP_MD_CTX* context;
};

Sha256::Sha256() : state_(std::make_unique<State>()) {}
Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;

void Sha256::write(const void* data, std::size_t size) {
  if (EVP_DigestUpdate(state_->context, data, size) != 1) throw Error("the library OpenSSL failed in SHA-256");
}

Digest Sha256::finish() {
  Digest digest{};
  if (EVP_DigestFinal_ex(state_->context, digest.data(), nullptr) != 1)
    throw Error("the library OpenSSL failed in SHA-256");
  return digest;
}

Digest sha256(const void* data, std::size_t size) {
  Sha256 sum;
  sum.write(data, size);
  return sum.finish();
}

std::string to_hex(const Digest& digest) { return hex_digits(digest); }

}  // namespace papilla
