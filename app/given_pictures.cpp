#include "app/given_pictures.hpp"

#include "core/errors.hpp"
#include "engine/image_file.hpp"

#include <string>
#include <utility>

#include <spdlog/spdlog.h>

namespace touchtrial::app {

void add_bits_option(CLI::App& command, int& bits) {
  command
      .add_option("--bits", bits,
                  "Bits of a 16-bit picture that its camera or scanner uses, 9 to 16")
      ->check(CLI::Range(9, 16));
}

GreyImage read_given_picture(const std::filesystem::path& path, int bits) {
  engine::Picture picture = engine::read_picture(path, bits);
  for (const std::string& remark : engine::remarks_on(picture.notes)) {
    spdlog::warn("{}: {}", one_line(path.string()), remark);
  }
  return std::move(picture.grey);
}

}  // namespace touchtrial::app
