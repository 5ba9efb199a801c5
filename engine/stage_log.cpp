#include "engine/stage_log.hpp"

#include <array>
#include <cstddef>

namespace touchtrial::engine {

std::string_view name_of(StageState state) {
  constexpr std::array<std::string_view, 3> kNames = {"computed", "reused", "skipped"};
  return kNames.at(static_cast<std::size_t>(state));
}

}  // namespace touchtrial::engine
