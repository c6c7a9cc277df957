#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "marey/core/rig.h"
#include "marey/source/live/phone_server.h"

namespace marey::cli {

/// A QR code of `text` for a terminal, two rows of modules a line. Throws Error for a text that is too long for one.
std::string qr_code(const std::string& text);

/// What a live run says about the phones among its cameras.
class PhonesScreen {
 public:
  /// The pages for phones are there from now on. Throws Error if a port cannot be had.
  explicit PhonesScreen(const Rig& rig);

  /// How to open them, with a code where standard error is a terminal; nothing without phones.
  void invite() const;
  /// Sentences for what phones reported since the last call: "phone left: battery 12 %".
  std::vector<std::string> news();

 private:
  std::vector<std::shared_ptr<source::live::PhoneServer>> servers_;
  std::map<std::string, std::string> stated_;  // by camera
};

}  // namespace marey::cli
