#include "core/errors.hpp"

namespace touchtrial {

std::string one_line(const std::string& text) {
  std::string line = text;
  for (char& c : line) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7f) c = ' ';
  }
  return line;
}

}  // namespace touchtrial
