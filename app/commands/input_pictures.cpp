#include "app/commands/input_pictures.hpp"

#include "core/errors.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"

#include <cmath>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

/// \throws CLI::ValidationError if the text is not two finite numbers, the first below the second
std::pair<double, double> parse_range(const std::string& text) {
  const std::size_t comma = text.find(',');
  const auto low = number_in<double>(text.substr(0, comma));
  const auto high =
      comma == std::string::npos ? std::nullopt : number_in<double>(text.substr(comma + 1));
  if (low && high && *low < *high && std::isfinite(*high - *low)) return {*low, *high};
  throw CLI::ValidationError(
      "--heights",
      "must be LOWEST,HIGHEST, two numbers in ascending order, not " + in_quotes(text));
}

}  // namespace

void add_sample_options(CLI::App& command, engine::SampleScale& scale) {
  command
      .add_option("--bits", scale.bits, "Bit depth of the camera or scanner, for 16-bit pictures")
      ->check(CLI::Range(9, 16));
  command.add_option_function<std::string>(
      "--heights", [&scale](const std::string& text) { scale.heights = parse_range(text); },
      "LOWEST,HIGHEST: values of floating-point pictures that map to black and white (default: "
      "each picture's own)");
}

GreyImage read_input_picture(const std::filesystem::path& path, const engine::SampleScale& scale) {
  engine::Picture picture = engine::read_picture(path, scale);
  for (const std::string& remark : engine::remarks_on(picture.notes)) {
    spdlog::warn("{}: {}", one_line(path.string()), remark);
  }
  return std::move(picture.grey);
}

}  // namespace touchtrial::app
