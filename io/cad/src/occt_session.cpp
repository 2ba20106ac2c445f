// SPDX-License-Identifier: MIT
#include "occt_session.hpp"

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>

namespace papilla::cad {
namespace {

std::mutex g_occt;

}  // namespace

OcctSession::OcctSession() : lock_(g_occt), printers_(Message::DefaultMessenger()->Printers()) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
}

OcctSession::~OcctSession() { Message::DefaultMessenger()->ChangePrinters() = printers_; }

OcctProgress::OcctProgress(const ProgressCallback& progress, std::string_view stage, double from, double to)
    : progress_(progress), stage_(stage), from_(from), to_(to) {}

void OcctProgress::Show(const Message_ProgressScope&, Standard_Boolean) {
  if (!progress_ || std::this_thread::get_id() != owner_) return;
  const double done = GetPosition();
  if (done < shown_ + 0.01) return;
  shown_ = done;
  report_progress(progress_, stage_, from_ + done * (to_ - from_));
}

}  // namespace papilla::cad
