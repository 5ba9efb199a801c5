// A file far larger than its picture must not cost memory for its size.
#include "core/errors.hpp"
#include "core/files.hpp"
#include "engine/image_samples.hpp"
#include "support/catch.hpp"

#include <filesystem>
#include <fstream>
#include <string>

using namespace touchtrial;
using namespace touchtrial::engine;
using namespace touchtrial::samples;

namespace {

constexpr std::uintmax_t kHugeBytes = std::uintmax_t{3} << 29U;  // 1.5 GiB, a hole on disk
constexpr long kModest_kib = 64L << 10U;

/// The peak memory of this process, in KiB.
long peak_memory_kib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stol(line.substr(6));
  }
  return 0;
}

/// A file that starts with these bytes and continues with zeros.
class HugeFile {
 public:
  explicit HugeFile(const Bytes& start) : path_(folder_.path() / "huge") {
    std::ofstream(path_, std::ios::binary) << text_of(start);
    std::filesystem::resize_file(path_, kHugeBytes);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  TempFolder folder_;
  std::filesystem::path path_;
};

void check_refused_cheaply(const Bytes& start) {
  const HugeFile file(start);
  const long before_kib = peak_memory_kib();
  CHECK_THROWS_AS(read_grey_image(file.path()), FileError);
  CHECK(peak_memory_kib() - before_kib < kModest_kib);
}

}  // namespace

TEST_CASE("1.5 GiB of zeros are refused at the cost of a few pages") {
  check_refused_cheaply({});
  check_refused_cheaply(text("GIF89a"));
  check_refused_cheaply(text("RIFF1234WEBP"));
}

TEST_CASE("1.5 GiB of junk after the start of a picture are refused at the cost of a few pages") {
  check_refused_cheaply(hex("89504e470d0a1a0a"));
  check_refused_cheaply(hex("ffd8ffe0"));
  check_refused_cheaply(text(std::string_view("II*\0", 4)));
  check_refused_cheaply(text("BM"));
  check_refused_cheaply(text("P5 99999 99999 255\n"));
}

TEST_CASE("a small picture with 1.5 GiB after its end costs no more than the picture") {
  const Raster colour = colour_picture();
  for (const Bytes& picture : {png_file(colour), jpeg_file(colour), tiff_file(colour),
                               bmp_file(colour), ppm_file(colour)}) {
    const HugeFile file(picture);
    const long before_kib = peak_memory_kib();
    CHECK(read_grey_image(file.path()) == read_bytes(picture));
    CHECK(peak_memory_kib() - before_kib < kModest_kib);
  }
}
