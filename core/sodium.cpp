#include "core/sodium.hpp"

#include <sodium.h>

namespace touchtrial {

bool prepare_sodium() noexcept {
  static const bool works = sodium_init() >= 0;
  return works;
}

}  // namespace touchtrial
