#include "core/utc.hpp"

#include <cstdio>

namespace touchtrial {

std::string utc_text(std::chrono::seconds since_1970) {
  const std::chrono::sys_seconds time{since_1970};
  const auto day = std::chrono::floor<std::chrono::days>(time);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss clock(time - day);
  char text[32];
  std::snprintf(text, sizeof text, "%04d-%02u-%02uT%02d:%02d:%02dZ", static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
                static_cast<int>(clock.seconds().count()));
  return text;
}

std::string utc_words(std::chrono::nanoseconds since_1970) {
  const std::string text = utc_text(since_1970);
  return text.substr(0, 10) + " " + text.substr(11, 5) + " UTC";
}

std::string utc_day(std::chrono::nanoseconds since_1970) {
  return utc_text(since_1970).substr(0, 10);
}

}  // namespace touchtrial
