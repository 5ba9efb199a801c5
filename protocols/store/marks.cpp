#include "protocols/store/marks.hpp"

#include <array>
#include <utility>

namespace touchtrial::store {
namespace {

constexpr std::array<std::pair<Mark, std::string_view>, 13> kMarkNames = {
    {{Mark::session_begins, "session-begins"},
     {Mark::session_ends, "session-ends"},
     {Mark::plane_on, "plane-on"},
     {Mark::contact, "contact"},
     {Mark::plane_off, "plane-off"},
     {Mark::time_up, "time-up"},
     {Mark::answered, "answered"},
     {Mark::interrupted, "interrupted"},
     {Mark::paused, "paused"},
     {Mark::resumed, "resumed"},
     {Mark::break_taken, "break-taken"},
     {Mark::stopped, "stopped"},
     {Mark::practised, "practised"}}};

}  // namespace

std::string_view name_of(Mark mark) noexcept {
  for (const auto& [known, name] : kMarkNames) {
    if (known == mark) return name;
  }
  return "unknown";
}

}  // namespace touchtrial::store
