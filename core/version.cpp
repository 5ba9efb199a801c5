#include "core/version.hpp"

namespace touchtrial {

std::string_view program_version() noexcept {
  return TOUCHTRIAL_VERSION;
}

}  // namespace touchtrial
