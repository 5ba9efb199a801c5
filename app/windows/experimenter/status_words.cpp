#include "app/windows/experimenter/status_words.hpp"

#include "core/named.hpp"

#include <array>
#include <cstddef>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

bool begins_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
}

}  // namespace

const char* level_word(session::HandLevel level) noexcept {
  using enum session::HandLevel;
  static constexpr auto kNames =
      std::to_array<Named<session::HandLevel>>({{"low", low}, {"right", right}, {"high", high}});
  return name_in(kNames, level).data();
}

std::string stop_advice(const session::SessionStatus& status) {
  if (!status.participant_stopped) return "";
  return std::string("Ask how they are, and enter the reason as a deviation (code ") +
         session::kComfortStopCode + "). " +
         (status.needs_consent
              ? "The force stays off until you switch it on again (g); abort ends the session."
              : "They continue by themselves; abort ends the session.");
}

std::string progress_words(const session::SessionStatus& status) {
  std::string words = status.alert.empty() ? "" : "ALERT: " + status.alert + "  ";
  words += status.participant + "  " + status.stage;
  if (status.practice && status.stage != "practice") words += " (practice)";
  if (status.participant_stopped) words += " by the participant";
  if (status.trial > 0) words += fmt::format("  trial {} of {}", status.trial, status.total);
  if (status.interruptions > 0) words += fmt::format("  interruptions {}", status.interruptions);
  return words;
}

std::string status_line(const session::SessionStatus& status) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(status.elapsed).count();
  std::string line = progress_words(status);
  line += fmt::format("  {}:{:02}", seconds / 60, seconds % 60);
  if (!status.device.empty()) line += "  " + status.device;
  if (status.hand) {
    line += fmt::format("  force {}  speed {}", level_word(status.hand->force),
                        level_word(status.hand->speed));
  } else if (status.rate_hz > 0.0) {
    line += fmt::format("  {:.0f}/s  late {:.0f} us  overruns {}", status.rate_hz,
                        status.lateness_p99_us, status.overruns);
  }
  return line;
}

std::string first_characters(const std::string& text, int columns) {
  std::size_t end = 0;
  for (int column = 0; end < text.size(); ++end) {
    if (begins_character(text[end]) && ++column > columns) break;
  }
  return text.substr(0, end);
}

std::string last_characters(const std::string& text, int columns) {
  std::size_t begin = text.size();
  for (int column = 0; begin > 0 && column < columns; --begin) {
    if (begins_character(text[begin - 1])) ++column;
  }
  return text.substr(begin);
}

}  // namespace touchtrial::app
