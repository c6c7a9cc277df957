#include "phones_screen.h"

#include <cstdio>

#include <fmt/format.h>
#include <qrencode.h>
#include <unistd.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/source/live/phone.h"

namespace marey::cli {
namespace {

constexpr int kQuiet = 2;  // modules of light around a code, without which no phone finds it

}  // namespace

std::string qr_code(const std::string& text) {
  const std::unique_ptr<QRcode, void (*)(QRcode*)> code(QRcode_encodeString8bit(text.c_str(), 0, QR_ECLEVEL_L), QRcode_free);
  if (code == nullptr) throw Error("{} bytes are too long for a QR code", text.size());
  const auto dark = [&](int x, int y) {
    const bool inside = x >= 0 && y >= 0 && x < code->width && y < code->width;
    return inside && (code->data[y * code->width + x] & 1) != 0;
  };
  // Light modules are drawn: terminals are dark, and a code's background must be light.
  std::string drawn;
  for (int y = -kQuiet; y < code->width + kQuiet; y += 2) {
    for (int x = -kQuiet; x < code->width + kQuiet; ++x) {
      const bool upper = !dark(x, y), lower = !dark(x, y + 1);
      drawn += upper && lower ? "█" : upper ? "▀" : lower ? "▄" : " ";
    }
    drawn += "\n";
  }
  return drawn;
}

PhonesScreen::PhonesScreen(const Rig& rig) : servers_(source::live::phone_servers_of(rig)) {}

void PhonesScreen::invite() const {
  for (const auto& server : servers_) {
    fmt::print(stderr,
               "marey: open {} on each phone, in the same network\n"
               "       (its browser warns once of a certificate made on the spot; its SHA-256 is {})\n",
               server->address(), server->fingerprint());
    if (isatty(STDERR_FILENO) != 0) fmt::print(stderr, "{}", qr_code(server->address()));
  }
}

std::vector<std::string> PhonesScreen::news() {
  std::vector<std::string> sentences;
  for (const auto& server : servers_) {
    for (const source::live::PhoneState& state : server->states()) {
      std::string& before = stated_[state.camera];
      if (before == state.stated) continue;
      before = state.stated;
      if (!before.empty()) sentences.push_back(fmt::format("phone {}: {}", state.camera, plain_text(before)));
    }
  }
  return sentences;
}

}  // namespace marey::cli
