// SPDX-License-Identifier: MIT
#pragma once

#include <Message_ProgressIndicator.hxx>
#include <Message_SequenceOfPrinters.hxx>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "papilla/core/progress.hpp"

namespace papilla::cad {

/// While it lives, OpenCASCADE prints nothing, and no other thread is inside read_cad(): the library's readers
/// share global parameters.
class OcctSession {
 public:
  OcctSession();
  ~OcctSession();
  OcctSession(const OcctSession&) = delete;
  OcctSession& operator=(const OcctSession&) = delete;

 private:
  std::unique_lock<std::mutex> lock_;
  Message_SequenceOfPrinters printers_;
};

/// Hands OpenCASCADE's progress to a ProgressCallback, from the calling thread only and in steps of a percent.
class OcctProgress : public Message_ProgressIndicator {
 public:
  OcctProgress(const ProgressCallback& progress, std::string_view stage, double from, double to);

 protected:
  void Show(const Message_ProgressScope& scope, Standard_Boolean force) override;

 private:
  const ProgressCallback& progress_;
  std::string stage_;
  double from_, to_;
  double shown_ = -1;
  std::thread::id owner_ = std::this_thread::get_id();
};

}  // namespace papilla::cad
