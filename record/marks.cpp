#include "record/marks.hpp"

#include "core/named.hpp"

#include <array>

namespace touchtrial::record {
namespace {

constexpr auto kMarkNames = std::to_array<Named<Mark>>({{"session-begins", Mark::session_begins},
                                                        {"session-ends", Mark::session_ends},
                                                        {"plane-on", Mark::plane_on},
                                                        {"contact", Mark::contact},
                                                        {"plane-off", Mark::plane_off},
                                                        {"time-up", Mark::time_up},
                                                        {"answered", Mark::answered},
                                                        {"interrupted", Mark::interrupted},
                                                        {"paused", Mark::paused},
                                                        {"resumed", Mark::resumed},
                                                        {"break-taken", Mark::break_taken},
                                                        {"stopped", Mark::stopped},
                                                        {"practised", Mark::practised}});

}  // namespace

std::string_view name_of(Mark mark) noexcept {
  return name_in(kMarkNames, mark);
}

}  // namespace touchtrial::record
