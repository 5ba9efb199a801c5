#include "engine/pack/field_file.hpp"

#include "core/errors.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "engine/rendering/sample_fields.hpp"
#include "support/catch.hpp"
#include "support/guarded_bytes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace touchtrial {
namespace {

const std::filesystem::path kName = "pack/0123456789abcdef.field";

template <typename Value>
Bytes with_value(Bytes file, std::size_t offset, Value value) {
  std::memcpy(file.data() + offset, &value, sizeof value);
  return file;
}

std::string refusal_of(const Bytes& file) {
  try {
    static_cast<void>(engine::decode_field(file, kName));
  } catch (const FileError& error) {
    return error.what();
  }
  return "accepted";
}

TEST_CASE("encode_field lays the header and the samples out as documented") {
  const std::vector<engine::FieldSample> samples = {{1.0F, 2.0F, 3.0F}, {4.0F, 5.0F, 6.0F}};
  const Bytes file = engine::encode_field({{0.25, 1, 2}, samples});
  REQUIRE(file.size() == 64 + 2 * 12);
  CHECK(text_of(ByteView(file).first(8)) == "TTFIELD1");
  CHECK(to_hex(ByteView(file).subspan(8, 16)) == "02000000010000000100000002000000");
  CHECK(to_hex(ByteView(file).subspan(24, 8)) == "000000000000d03f");
  CHECK(to_hex(ByteView(file).subspan(32, 8)) == "0000000000001040");
  CHECK(std::all_of(file.begin() + 40, file.begin() + 64, [](std::uint8_t b) { return b == 0; }));
  CHECK(to_hex(ByteView(file).subspan(64, 12)) == "0000803f0000004000004040");
}

TEST_CASE("decode_field gives back what encode_field was given") {
  const int height = GENERATE(1, 3, 20);
  const int width = GENERATE(1, 17);
  const engine::TextureField field = random_field(height, width, 1);
  const Bytes file = engine::encode_field(field.view());
  const engine::FieldView read = engine::decode_field(file, kName);
  CHECK(read.geometry.height_px == height);
  CHECK(read.geometry.width_px == width);
  CHECK(read.geometry.pitch_mm == 0.2);
  REQUIRE(read.samples.size() == field.view().samples.size());
  CHECK(std::memcmp(read.samples.data(), field.view().samples.data(), read.samples.size_bytes()) ==
        0);
}

TEST_CASE("a surface's file holds coefficients alone, a third of the bytes") {
  const engine::TextureField surface = random_surface(20, 17, 1);
  const Bytes file = engine::encode_field(surface.view());
  REQUIRE(file.size() == 64 + 20 * 17 * 4);
  CHECK(engine::encode_field(random_field(20, 17, 1).view()).size() == 64 + 20 * 17 * 12);
  const engine::FieldView read = engine::decode_field(file, kName);
  CHECK(read.model() == engine::ModelKind::surface);
  CHECK(read.samples.empty());
  CHECK(read.highest == surface.view().highest);
  CHECK(std::ranges::equal(read.coefficients, surface.view().coefficients));
}

TEST_CASE("decode_field and the model of what it finds read the header's page alone") {
  const engine::TextureField field =
      GENERATE(0, 1) == 0 ? random_field(80, 90, 1) : random_surface(80, 90, 1);
  const Bytes file = engine::encode_field(field.view());
  GuardedBytes guarded(std::as_bytes(std::span(file)));
  guarded.leave_only({0});
  const engine::FieldView read = engine::decode_field(guarded.as<std::uint8_t>(), kName);
  engine::RenderingOptions options;
  options.model = read.model();
  const engine::RenderingModel model(read, options, {0.01, 0.01, 0.01});
  engine::Bristle touch;
  CHECK(model.force_n({9.0, 8.0, 50.0}, {}, touch) == Vec3{});
  CHECK(guarded.pages() > 4);
}

TEST_CASE("the header says how high a field reaches") {
  const engine::TextureField field = random_field(9, 8, 3);
  float highest = 0.0F;
  for (const engine::FieldSample& sample : field.view().samples)
    highest = std::max(highest, sample.surface);
  CHECK(engine::decode_field(engine::encode_field(field.view()), kName).highest == double{highest});
  engine::FieldView unlooked = field.view();
  unlooked.highest = std::numeric_limits<double>::infinity();
  CHECK(engine::decode_field(engine::encode_field(unlooked), kName).highest == double{highest});
}

TEST_CASE("decode_field refuses a field of the former version, and a height that is no number") {
  const Bytes file = engine::encode_field(random_field(2, 3, 4).view());
  CHECK(refusal_of(with_value(file, 8, std::uint32_t{1})) ==
        kName.string() +
            ": has field version 1, not 2; copy the pack again or rebuild it with `touchtrial "
            "prepare`");
  CHECK(refusal_of(with_value(file, 32, std::nan(""))).find("no highest point") !=
        std::string::npos);
}

TEST_CASE("encode_field makes files of one size from fields of one size") {
  const engine::TextureField flat = flat_field(30, 20);
  const engine::TextureField rough = random_field(30, 20, 2, 100.0);
  CHECK(engine::encode_field(flat.view()).size() == engine::encode_field(rough.view()).size());
}

TEST_CASE("encode_field refuses a view that is not a field") {
  std::vector<engine::FieldSample> samples(6);
  CHECK_THROWS_AS(engine::encode_field({}), std::invalid_argument);
  CHECK_THROWS_AS(engine::encode_field({{0.2, 2, 4}, samples}), std::invalid_argument);
  CHECK_THROWS_AS(engine::encode_field({{0.2, -2, -3}, samples}), std::invalid_argument);
  CHECK_THROWS_AS(engine::encode_field({{0.0, 2, 3}, samples}), std::invalid_argument);
  CHECK_THROWS_AS(engine::encode_field({{std::nan(""), 2, 3}, samples}), std::invalid_argument);
  samples[4].surface = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_AS(engine::encode_field({{0.2, 2, 3}, samples}), std::invalid_argument);
}

TEST_CASE("decode_field refuses a file cut anywhere, or with more behind it") {
  const Bytes file = engine::encode_field(random_field(2, 3, 3).view());
  for (std::size_t size = 0; size < file.size(); ++size) {
    const Bytes cut(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size));
    REQUIRE_THROWS_AS(engine::decode_field(cut, kName), FileError);
  }
  Bytes longer = file;
  longer.push_back(0);
  CHECK(refusal_of(longer).find("truncated or overlong") != std::string::npos);
}

TEST_CASE("decode_field refuses any other magic, version, layout and reserved byte") {
  const Bytes file = engine::encode_field(random_field(2, 3, 4).view());
  for (std::size_t at = 0; at < 64; ++at) {
    if (at >= 24 && at < 40) continue;  // pitch and highest point may be other numbers
    Bytes changed = file;
    changed[at] ^= 0x41U;
    CAPTURE(at);
    REQUIRE_THROWS_AS(engine::decode_field(changed, kName), FileError);
  }
}

TEST_CASE("decode_field refuses dimensions that are absurd, overflow or do not fit the file") {
  const Bytes file = engine::encode_field(random_field(2, 3, 5).view());
  const auto sized = [&](std::uint32_t height, std::uint32_t width) {
    return refusal_of(with_value(with_value(file, 16, height), 20, width));
  };
  CHECK(sized(0, 3).find("impossible size 3 x 0") != std::string::npos);
  CHECK(sized(0xffffffffU, 0xffffffffU).find("impossible size") != std::string::npos);
  CHECK(sized(0x80000000U, 2).find("impossible size") != std::string::npos);
  CHECK(sized((1U << 28U) + 1U, 1).find("impossible size") != std::string::npos);
  CHECK(sized(1U << 28U, 1).find("truncated") != std::string::npos);
  CHECK(sized(3, 3).find("truncated") != std::string::npos);
}

TEST_CASE("decode_field refuses a pitch that is not a finite number above zero") {
  const Bytes file = engine::encode_field(random_field(2, 3, 6).view());
  const double pitch_mm = GENERATE(0.0, -0.2, std::numeric_limits<double>::infinity(),
                                   std::numeric_limits<double>::quiet_NaN());
  CHECK(refusal_of(with_value(file, 24, pitch_mm)).find("pitch") != std::string::npos);
}

TEST_CASE("decode_field names the file and a remedy on one line") {
  const std::string message = refusal_of(Bytes(10));
  CHECK(message.find(kName.string()) == 0);
  CHECK(message.find("touchtrial prepare") != std::string::npos);
  CHECK(message.find('\n') == std::string::npos);
}

}  // namespace
}  // namespace touchtrial
