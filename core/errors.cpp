#include "core/errors.hpp"

#include "core/printable.hpp"

namespace touchtrial {

std::string one_line(const std::string& text) {
  return printable(text, Controls::as_spaces);
}

}  // namespace touchtrial
