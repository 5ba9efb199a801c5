#include "app/commands.hpp"

#include <charconv>
#include <cstdint>
#include <string>
#include <system_error>

namespace touchtrial {

CLI::Validator seed_validator() {
  return CLI::Validator(
      [](const std::string& text) {
        std::uint64_t seed = 0;
        const char* end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data(), end, seed);
        if (error == std::errc{} && stop == end) return std::string();
        return text + " is not a whole number from 0 to 18446744073709551615";
      },
      "UINT64");
}

}  // namespace touchtrial
