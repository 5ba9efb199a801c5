#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/random.hpp"
#include "engine/image_samples.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <cstdio>
#include <functional>

#include <fcntl.h>
#include <unistd.h>

using namespace touchtrial;
using namespace touchtrial::engine;
using namespace touchtrial::samples;

namespace {

/// The message of the FileError that reading throws; "" if it throws nothing.
std::string error_of(const Bytes& bytes) {
  return message_of<FileError>([&] { return read_bytes(bytes); });
}

bool is_readable_or_refused(const Bytes& bytes) {
  const std::string error = error_of(bytes);
  return error.find('\n') == std::string::npos;
}

/// What the process writes to standard output and standard error during `action`.
std::string printed_by(const std::function<void()>& action) {
  const TempFolder folder;
  const auto path = folder.path() / "printed";
  std::fflush(nullptr);
  const int file = ::open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
  const int out = ::dup(STDOUT_FILENO);
  const int err = ::dup(STDERR_FILENO);
  ::dup2(file, STDOUT_FILENO);
  ::dup2(file, STDERR_FILENO);
  action();
  std::fflush(nullptr);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  for (const int descriptor : {file, out, err}) ::close(descriptor);
  return text_of(read_file(path));
}

Bytes without_end(Bytes bytes, std::size_t count) {
  bytes.resize(bytes.size() - count);
  return bytes;
}

/// A JPEG whose scan stops half-way, with an end marker after it.
Bytes jpeg_with_short_scan() {
  Bytes file = jpeg_file(colour_picture());
  file.resize(file.size() * 3 / 4);
  append(file, {0xFF, 0xD9});
  return file;
}

/// A PNG, JPEG, BMP, TIFF and PGM that consist of a header alone.
std::vector<Bytes> headers(std::uint32_t width, std::uint32_t height) {
  Bytes png = hex("89504e470d0a1a0a0000000d49484452");
  append(png, numbers({width, height}, 4, true));
  append(png, hex("080000000000000000"));
  Bytes jpeg = hex("ffd8ffc0000b08");
  append(jpeg, numbers({height % 65536, width % 65536}, 2, true));
  append(jpeg, hex("01011100"));
  const auto side = [](std::uint32_t value) { return static_cast<std::int32_t>(value); };
  return {png, jpeg, Bmp{side(width), side(height), 8, {}, {}, 0, {}}.bytes(),
          Tiff(width, height, {1, 2, 3, 4}).bytes(),
          text("P5 " + std::to_string(width) + " " + std::to_string(height) + " 255\n")};
}

Bytes mutated(const Bytes& original, RandomStream& random) {
  Bytes file = original;
  for (std::uint64_t changes = 1 + random.below(4); changes > 0; --changes) {
    std::uint8_t& byte = file[random.below(file.size())];
    byte = random.below(2) == 0 ? static_cast<std::uint8_t>(random.below(256))
                                : static_cast<std::uint8_t>(byte ^ (1U << random.below(8)));
  }
  if (random.below(4) == 0) file.resize(random.below(file.size()));
  return file;
}

}  // namespace

TEST_CASE("a file that is missing, a folder or empty is refused by name") {
  const TempFolder folder;
  CHECK_THROWS_AS(read_grey_image(folder.path() / "none.png"), FileError);
  CHECK_THROWS_WITH(read_grey_image(folder.path() / "none.png"), holds_text("none.png"));
  CHECK_THROWS_AS(read_grey_image(folder.path()), FileError);
  CHECK_THAT(error_of({}), names("[empty-picture]"));
}

TEST_CASE("a file that is not a picture of a known kind is refused, and foreign kinds are named") {
  CHECK_THAT(error_of(text("Dear reader")), names("[not-a-picture]"));
  CHECK_THAT(error_of(Bytes(4096, 0)), names("[not-a-picture]"));
  CHECK_THAT(error_of(text("RIFF1234WEBPVP8 ")), holds_text("WebP"));
  CHECK_THAT(error_of(text("P4 1 1\n1")), holds_text("PBM"));
}

TEST_CASE("an error is one line that names the file, even if its name is hostile") {
  const TempFolder folder;
  const auto path = folder.path() / "two\nlines.png";
  replace_file(path, "Dear reader");
  CHECK_THROWS_WITH(read_grey_image(path), names("lines.png"));
}

TEST_CASE("every truncated picture is refused, and the complete one is read") {
  for (const auto& [kind, file] : one_of_each_kind()) {
    INFO(kind);
    CHECK(error_of(file).empty());
    for (std::size_t cut = 1; cut <= file.size(); ++cut) {
      INFO(cut << " bytes missing");
      // A JPEG of one scan and a GIF are whole without their end markers.
      const bool is_whole = (kind == "jpeg" && cut <= 2) || (kind == "gif" && cut == 1);
      REQUIRE(error_of(without_end(file, cut)).empty() == is_whole);
    }
  }
}

TEST_CASE("pictures that do not unpack are refused as damaged") {
  Bytes changed = png_file(colour_picture());
  changed[changed.size() / 2] ^= 0x10U;
  Bytes long_run = packed_bmp();
  long_run[54 + 16] = 6;
  Tiff two_predictors(2, 1, hex("789ce3fa1fd50800045e01e5"));  // libtiff would ignore both
  two_predictors.with(258, {8, 8}).with(277, {2}).with(338, {2}).with(259, {8}).with(317, {2, 2});
  std::vector<Bytes> files = {jpeg_with_short_scan(), changed, long_run, two_predictors.bytes()};
  for (const std::uint32_t bits : {8U, 16U}) {
    for (const std::uint32_t compression : {5U, 8U}) {
      const Bytes nonsense(30, 0x5A);
      files.push_back(Tiff(20, 20, nonsense).with(258, {bits}).with(259, {compression}).bytes());
    }
  }
  for (std::size_t i = 0; i < files.size(); ++i) {
    INFO("file " << i);
    CHECK_THAT(error_of(files[i]), names("[damaged-picture]") || names("[truncated-picture]"));
  }
}

TEST_CASE("a picture of no pixels is refused") {
  for (const Bytes& file : headers(0, 7)) CHECK_THAT(error_of(file), names("0 7"));
  for (const Bytes& file : headers(7, 0)) CHECK_THAT(error_of(file), names("7 0"));
}

TEST_CASE("a picture of more than 2^28 pixels is refused from its header") {
  for (const Bytes& file : headers(16385, 16384)) {
    CHECK_THAT(error_of(file), names("268435456"));
  }
  for (const Bytes& file : headers(65535, 65535)) {
    CHECK_THAT(error_of(file), names("268435456"));
  }
  CHECK_FALSE(error_of(text("P5 399999999 399999999 255\n")).empty());
}

TEST_CASE("a header of exactly 2^28 pixels is not too large, only truncated") {
  for (const Bytes& file : headers(16384, 16384)) {
    CHECK_THAT(error_of(file), names("[truncated-picture]"));
  }
}

TEST_CASE("sample types other than unsigned 8 and 16 bits are refused") {
  const Bytes four = {0, 0, 0, 0};
  CHECK_THAT(error_of(Tiff(1, 1, four).with(258, {32}).bytes()), holds_text("32-bit"));
  CHECK_FALSE(error_of(Tiff(2, 1, four).with(258, {16}).with(339, {3}).bytes()).empty());
  CHECK_FALSE(error_of(Tiff(2, 1, four).with(258, {16}).with(339, {2}).bytes()).empty());
  Bytes jpeg = jpeg_file(colour_picture());
  const Bytes frame_start = {0xFF, 0xC0};
  const auto frame = std::search(jpeg.begin(), jpeg.end(), frame_start.begin(), frame_start.end());
  REQUIRE(frame != jpeg.end());
  frame[4] = 12;
  CHECK_THAT(error_of(jpeg), names("8"));
}

TEST_CASE("a PGM sample above the stated maximum is refused") {
  CHECK_FALSE(error_of(text("P2 1 1 100 101")).empty());
  CHECK_THAT(error_of(text("P2 1 1 70000 1")), holds_text("65535"));
}

TEST_CASE("a TIFF in which a tag appears twice is ambiguous and refused") {
  Bytes file = Tiff(2, 2, {1, 2, 3, 4}).bytes();
  const std::size_t second_entry = 8 + 4 + 2 + 12;
  REQUIRE(file[second_entry] == 1);  // 257 = 0x0101
  file[second_entry] = 0;            // 256 = 0x0100
  CHECK_FALSE(error_of(file).empty());
}

TEST_CASE("nothing is printed, even if the decoders complain") {
  Bytes metadata = png_file(colour_picture());
  const Bytes bad_profile = hex("00000004694343500000000000000000");
  metadata.insert(metadata.begin() + 33, bad_profile.begin(), bad_profile.end());
  Bytes flipped = png_file(colour_picture());
  flipped[flipped.size() / 2] ^= 0x10U;
  const std::vector<Bytes> files = {
      metadata,
      flipped,
      jpeg_with_short_scan(),
      without_end(jpeg_file(colour_picture()), 20),
      Tiff(20, 20, Bytes(30, 0x5A)).with(259, {5}).bytes(),
      Tiff(20, 20, Bytes(30, 0x5A)).with(258, {16}).with(259, {8}).bytes(),
      Tiff(2, 2, {1, 2, 3, 4}).with(65001, {1}).bytes(),
      Bmp{4, 4, 8, {0, 9, 0, 9, 0, 9}, Bytes(1024), 1, {}}.bytes(),
      without_end(gif_file(), 4),
      text("P5 3 3 255\nab")};
  const std::string printed = printed_by([&] {
    for (const Bytes& file : files) static_cast<void>(error_of(file));
  });
  CHECK(printed.empty());
}

TEST_CASE("a little padding before the end of a JPEG is harmless, more is damage") {
  const auto padded = [](std::size_t count) {
    Bytes file = without_end(jpeg_file(colour_picture()), 2);
    append(file, Bytes(count, 1));
    append(file, {0xFF, 0xD9});
    return file;
  };
  CHECK(read_bytes(padded(2)) == read_bytes(padded(0)));
  CHECK(error_of(padded(16)).empty());
  CHECK_THAT(error_of(padded(500)), names("0xd9"));
}

TEST_CASE("a JPEG of a later JFIF revision is read, and refused if it is damaged as well") {
  Bytes file = jpeg_file(colour_picture());
  REQUIRE(file[11] == 1);  // the major revision
  file[11] = 3;
  CHECK(read_bytes(file) == read_bytes(jpeg_file(colour_picture())));
  file.resize(file.size() * 3 / 4);
  append(file, {0xFF, 0xD9});
  CHECK_THAT(error_of(file), names("[damaged-picture]") || names("[truncated-picture]"));
}

TEST_CASE("a JPEG of more scans than any encoder writes is refused before it is decoded") {
  const Bytes file = jpeg_file(colour_picture(), true);
  const Bytes scan_start = {0xFF, 0xDA};
  const auto scan = std::search(file.begin(), file.end(), scan_start.begin(), scan_start.end());
  const auto next = std::search(scan + 2, file.end(), file.begin(), file.begin() + 1);
  REQUIRE(next != file.end());
  Bytes bomb(file.begin(), scan);
  for (int i = 0; i < 101; ++i) append(bomb, Bytes(scan, next));
  append(bomb, {0xFF, 0xD9});
  CHECK_THAT(error_of(bomb), names("100"));
}

TEST_CASE("damaged notes are harmless, damaged transparency and palettes are not") {
  Bytes file = png_file(colour_picture());
  const Bytes pixels = file;
  const Bytes bad_profile = hex("00000004694343500000000000000000");
  file.insert(file.begin() + 33, bad_profile.begin(), bad_profile.end());
  CHECK(read_bytes(file) == read_bytes(pixels));
  file = pixels;
  const Bytes bad_transparency = hex("0000000674524e5300010002000300000000");
  file.insert(file.begin() + 33, bad_transparency.begin(), bad_transparency.end());
  CHECK_THAT(error_of(file), names("CRC"));
  CHECK(error_of(Tiff(2, 2, {1, 2, 3, 4}).with(65001, {1}).bytes()).empty());
  // A palette cannot have one entry; libtiff alone would read the samples as grey levels.
  const Tiff palette = Tiff(2, 2, {1, 2, 3, 4}).with(262, {3}).with(320, {1});
  CHECK_THAT(error_of(palette.bytes()), names("[damaged-picture]") || names("[truncated-picture]"));
}

TEST_CASE("a mutated picture is read or refused, whatever the mutation") {
  for (const auto& [kind, file] : one_of_each_kind()) {
    RandomStream random(20240817, kind);
    for (int i = 0; i < 400; ++i) {
      INFO(kind << ", mutation " << i);
      REQUIRE(is_readable_or_refused(mutated(file, random)));
    }
  }
}
