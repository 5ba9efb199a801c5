#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/random.hpp"
#include "engine/image_formats/decoder_complaints.hpp"
#include "image_samples.hpp"
#include "support/catch.hpp"

#include <cstdio>
#include <filesystem>
#include <functional>

#include <fcntl.h>
#include <unistd.h>

using namespace touchtrial;
using namespace touchtrial::engine;
using namespace touchtrial::samples;

namespace {

/// The message of the FileError that reading throws, or "" if it throws nothing.
std::string error_of(const Bytes& bytes) {
  try {
    static_cast<void>(read_bytes(bytes));
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

bool is_readable_or_refused(const Bytes& bytes) {
  const std::string error = error_of(bytes);
  return error.find('\n') == std::string::npos;
}

/// What `action` makes the process write to standard output and standard error.
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
  Bytes file = encoded(".jpg", colour_picture());
  file.resize(file.size() * 3 / 4);
  append(file, {0xFF, 0xD9});
  return file;
}

/// A header alone: width and height in a PNG, JPEG, BMP, TIFF and PGM.
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
  CHECK_THAT(error_of({}), holds_text("empty"));
}

TEST_CASE("what is not a picture of a known kind is refused, and foreign kinds are named") {
  CHECK_THAT(error_of(text("Dear reader")), holds_text("not an image of a known kind"));
  CHECK_THAT(error_of(Bytes(4096, 0)), holds_text("not an image of a known kind"));
  CHECK_THAT(error_of(text("GIF89a\1\1\1\1")), holds_text("GIF"));
  CHECK_THAT(error_of(text("RIFF1234WEBPVP8 ")), holds_text("WebP"));
  CHECK_THAT(error_of(text("P4 1 1\n1")), holds_text("PBM"));
}

TEST_CASE("an error is one line that names the file, even if its name is hostile") {
  const TempFolder folder;
  const auto path = folder.path() / "two\nlines.png";
  replace_file(path, "Dear reader");
  CHECK_THROWS_WITH(read_grey_image(path), holds_text("two lines.png") && holds_text("; "));
}

TEST_CASE("every beginning of a picture is refused, and the whole is not") {
  for (const auto& [kind, file] : one_of_each_kind()) {
    INFO(kind);
    CHECK(error_of(file).empty());
    for (std::size_t cut = 1; cut <= file.size(); ++cut) {
      INFO(cut << " bytes missing");
      REQUIRE_FALSE(error_of(without_end(file, cut)).empty());
    }
  }
}

TEST_CASE("a JPEG whose scan is cut is refused though an end marker follows") {
  CHECK_THAT(error_of(jpeg_with_short_scan()), holds_text("damaged"));
}

TEST_CASE("a PNG with a changed byte in its pixels is refused") {
  Bytes file = encoded(".png", colour_picture());
  file[file.size() / 2] ^= 0x10U;
  CHECK_THAT(error_of(file), holds_text("damaged"));
}

TEST_CASE("compressed TIFF strips that do not unpack are refused") {
  const std::uint32_t bits = GENERATE(8U, 16U);
  const std::uint32_t compression = GENERATE(5U, 8U);
  const Bytes nonsense(30, 0x5A);
  CHECK_THAT(error_of(Tiff(20, 20, nonsense).with(258, {bits}).with(259, {compression}).bytes()),
             holds_text("damaged"));
}

TEST_CASE("a picture of no pixels is refused") {
  for (const Bytes& file : headers(0, 7)) CHECK_THAT(error_of(file), holds_text("0 x 7 pixels"));
  for (const Bytes& file : headers(7, 0)) CHECK_THAT(error_of(file), holds_text("7 x 0 pixels"));
}

TEST_CASE("a picture of more than 2^28 pixels is refused from its header") {
  for (const Bytes& file : headers(16385, 16384)) {
    CHECK_THAT(error_of(file), holds_text("more than 268435456 pixels"));
  }
  for (const Bytes& file : headers(65535, 65535)) {
    CHECK_THAT(error_of(file), holds_text("more than 268435456 pixels"));
  }
  CHECK_THAT(error_of(text("P5 399999999 399999999 255\n")), holds_text("more than"));
}

TEST_CASE("a picture of exactly 2^28 pixels is not too large, only cut") {
  for (const Bytes& file : headers(16384, 16384)) {
    CHECK_THAT(error_of(file), holds_text("truncated"));
  }
}

TEST_CASE("sample types other than unsigned 8 and 16 bits are refused") {
  const Bytes four = {0, 0, 0, 0};
  CHECK_THAT(error_of(Tiff(1, 1, four).with(258, {32}).bytes()), holds_text("32-bit"));
  CHECK_THAT(error_of(Tiff(1, 1, four).with(258, {32}).with(339, {3}).bytes()),
             holds_text("floating-point"));
  CHECK_THAT(error_of(Tiff(2, 1, four).with(258, {16}).with(339, {2}).bytes()),
             holds_text("signed"));
  Bytes jpeg = encoded(".jpg", colour_picture());
  const Bytes frame_start = {0xFF, 0xC0};
  const auto frame = std::search(jpeg.begin(), jpeg.end(), frame_start.begin(), frame_start.end());
  REQUIRE(frame != jpeg.end());
  frame[4] = 12;
  CHECK_THAT(error_of(jpeg), holds_text("more than 8 bits"));
}

TEST_CASE("a PGM sample above the stated maximum is refused") {
  CHECK_THAT(error_of(text("P2 1 1 100 101")), holds_text("above its stated maximum"));
  CHECK_THAT(error_of(text("P2 1 1 70000 1")), holds_text("65535"));
}

TEST_CASE("a TIFF in which a tag comes twice has no meaning and is refused") {
  Bytes file = Tiff(2, 2, {1, 2, 3, 4}).bytes();
  const std::size_t second_entry = 8 + 4 + 2 + 12;
  REQUIRE(file[second_entry] == 1);  // 257 = 0x0101
  file[second_entry] = 0;            // 256 = 0x0100
  CHECK_FALSE(error_of(file).empty());
}

TEST_CASE("nothing is printed, whatever the decoders think of a file") {
  Bytes metadata = encoded(".png", colour_picture());
  const Bytes bad_profile = hex("00000004694343500000000000000000");
  metadata.insert(metadata.begin() + 33, bad_profile.begin(), bad_profile.end());
  Bytes flipped = encoded(".png", colour_picture());
  flipped[flipped.size() / 2] ^= 0x10U;
  const std::vector<Bytes> files = {
      metadata,
      flipped,
      jpeg_with_short_scan(),
      without_end(encoded(".jpg", colour_picture()), 20),
      Tiff(20, 20, Bytes(30, 0x5A)).with(259, {5}).bytes(),
      Tiff(20, 20, Bytes(30, 0x5A)).with(258, {16}).with(259, {8}).bytes(),
      Tiff(2, 2, {1, 2, 3, 4}).with(65001, {1}).bytes(),
      Bmp{4, 4, 8, {0, 9, 0, 9, 0, 9}, Bytes(1024), 1, {}}.bytes(),
      text("P5 3 3 255\nab")};
  const std::string printed = printed_by([&] {
    for (const Bytes& file : files) static_cast<void>(error_of(file));
  });
  CHECK(printed.empty());
}

TEST_CASE("standard error works again after a picture was decoded") {
  const std::string printed = printed_by([] {
    static_cast<void>(error_of(jpeg_with_short_scan()));
    std::fputs("back\n", stderr);
  });
  CHECK(printed == "back\n");
}

TEST_CASE("damage is told from harmless notes of the decoders") {
  CHECK(damage_in("Corrupt JPEG data: premature end of data segment\n").has_value());
  CHECK(damage_in("libpng warning: iCCP: known incorrect sRGB profile\n"
                  "libpng error: IDAT: CRC error\n") == "libpng error: IDAT: CRC error");
  CHECK(damage_in("OpenCV TIFF: ZIPDecode: Warning, Decoding error at scanline 0.\n"));
  CHECK(damage_in("Corrupt JPEG data: 500 extraneous bytes before marker 0xd9\n"));
  CHECK_FALSE(damage_in("Corrupt JPEG data: 2 extraneous bytes before marker 0xd9\n"));
  CHECK_FALSE(damage_in("OpenCV TIFF: TIFFReadDirectory: Warning, Unknown field with tag 65001\n"));
  CHECK_FALSE(damage_in("libpng warning: iCCP: known incorrect sRGB profile"));
  CHECK_FALSE(damage_in(""));
}

TEST_CASE("no mutation of a picture does worse than to be refused") {
  for (const auto& [kind, file] : one_of_each_kind()) {
    RandomStream random(20240817, kind);
    for (int i = 0; i < 400; ++i) {
      INFO(kind << ", mutation " << i);
      REQUIRE(is_readable_or_refused(mutated(file, random)));
    }
  }
}
