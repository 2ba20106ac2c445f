// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_answers.hpp"

#include <memory>
#include <utility>

#include "papilla/core/error.hpp"

namespace papilla::app {

PageAnswer json_answer(const Json& json) {
  return {200, "application/json",
          std::make_shared<const std::string>(json.dump(-1, ' ', false, Json::error_handler_t::replace))};
}

PageAnswer bytes_answer(const char* type, SharedText bytes) { return {200, type, std::move(bytes)}; }

SharedText framed(const Json& json, const std::string& bytes) {
  constexpr std::size_t k_align = 4;
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.append((k_align - text.size() % k_align) % k_align, ' ');
  std::string all(k_align, '\0');
  for (std::size_t i = 0; i < k_align; ++i) all[i] = static_cast<char>((text.size() >> (8 * i)) & 0xffU);
  return std::make_shared<const std::string>(all + text + bytes);
}

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

const std::string& required(const Query& query, const char* name) {
  const auto found = query.find(name);
  if (found == query.end()) throw InvalidInput(std::string("the request has no '") + name + "'");
  return found->second;
}

std::uint32_t number_of(const Query& query, const char* name) {
  const std::string& text = required(query, name);
  if (text.empty() || text.size() > 9 || text.find_first_not_of("0123456789") != std::string::npos)
    throw InvalidInput(std::string("'") + name + "' is no number");
  return static_cast<std::uint32_t>(std::stoul(text));
}

Json parsed(const std::string& body) {
  try {
    return Json::parse(body);
  } catch (const Json::exception&) {
    throw InvalidInput("the request is no JSON");
  }
}

}  // namespace papilla::app
