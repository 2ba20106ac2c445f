// SPDX-License-Identifier: MIT
#include "cad_text.hpp"

#include <TCollection_AsciiString.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>

namespace papilla::cad {

std::string utf8(const TCollection_ExtendedString& text) {
  std::string result(static_cast<std::size_t>(text.LengthOfCString()) + 1, '\0');
  char* data = result.data();
  result.resize(static_cast<std::size_t>(text.ToUTF8CString(data)));
  return result;
}

std::string text_of(const Handle(TCollection_HAsciiString) & text) {
  return text.IsNull() ? std::string() : std::string(text->ToCString());
}

std::string label_name(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  return label.FindAttribute(TDataStd_Name::GetID(), name) ? utf8(name->Get()) : std::string();
}

std::string entry_of(const TDF_Label& label) {
  TCollection_AsciiString entry;
  TDF_Tool::Entry(label, entry);
  return entry.ToCString();
}

std::string dump(const Json& object) {
  return object.empty() ? std::string() : object.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace papilla::cad
