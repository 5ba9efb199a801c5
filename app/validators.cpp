#include "app/commands.hpp"

#include <charconv>
#include <cstdint>
#include <string>
#include <system_error>

namespace touchtrial::app {

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

CLI::Validator place_validator() {
  return {[](const std::string& text) -> std::string {
            if (text.find("://") == std::string::npos) return "";
            return "an address is no file; a study on a server is written by sync, and read by "
                   "report, export, verify and merge";
          },
          ""};
}

CLI::Validator study_place_validator() {
  return {[](const std::string& text) -> std::string {
            if (text.find("password=") == std::string::npos) return "";
            return "a password does not belong on the command line; write "
                   "postgresql://USER@HOST/DATABASE, and lay it in ~/.pgpass";
          },
          ""};
}

}  // namespace touchtrial::app
