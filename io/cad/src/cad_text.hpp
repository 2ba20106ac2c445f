// SPDX-License-Identifier: MIT
#pragma once

#include <TCollection_ExtendedString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_Label.hxx>
#include <nlohmann/json.hpp>
#include <string>

namespace papilla::cad {

using Json = nlohmann::ordered_json;

std::string utf8(const TCollection_ExtendedString& text);
std::string text_of(const Handle(TCollection_HAsciiString) & text);
/// The label's name; empty when it has none.
std::string label_name(const TDF_Label& label);
/// The label's place in the document, as "0:1:1:3".
std::string entry_of(const TDF_Label& label);
/// One line of JSON with valid UTF-8, or nothing for an empty object.
std::string dump(const Json& object);

}  // namespace papilla::cad
