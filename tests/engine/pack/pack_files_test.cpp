#include "engine/pack/pack_files.hpp"

#include "core/errors.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "engine/rendering/sample_fields.hpp"
#include "support/catch.hpp"
#include "support/guarded_bytes.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace touchtrial {
namespace {

const std::filesystem::path kFieldPath = "pack/0123456789abcdef.field";

template <typename Value>
Bytes with_value(Bytes file, std::size_t offset, Value value) {
  std::memcpy(file.data() + offset, &value, sizeof value);
  return file;
}

std::string refusal_of(const Bytes& file) {
  return message_of<FileError>([&] { return engine::decode_field(file, kFieldPath); });
}

TEST_CASE("encode_field lays the header and the samples out as documented") {
  const std::vector<float> heights = {1.0F, 4.0F};
  const Bytes file =
      engine::encode_field({.geometry = {0.25, 1, 2}, .heights = heights, .neighbourhood = 5});
  REQUIRE(file.size() == 64 + 2 * 4);
  CHECK(text_of(ByteView(file).first(8)) == "TTFIELD1");
  CHECK(to_hex(ByteView(file).subspan(8, 16)) == "03000000030000000100000002000000");
  CHECK(to_hex(ByteView(file).subspan(24, 8)) == "000000000000d03f");
  CHECK(to_hex(ByteView(file).subspan(32, 8)) == "0000000000001040");
  CHECK(to_hex(ByteView(file).subspan(40, 4)) == "05000000");
  CHECK(std::all_of(file.begin() + 44, file.begin() + 64, [](std::uint8_t b) { return b == 0; }));
  CHECK(to_hex(ByteView(file).subspan(64, 8)) == "0000803f00008040");
}

TEST_CASE("decode_field gives back what encode_field was given") {
  const int height = GENERATE(1, 3, 20);
  const int width = GENERATE(1, 17);
  const engine::TextureField field = random_field(height, width, 1);
  const Bytes file = engine::encode_field(field.view());
  const engine::FieldView read = engine::decode_field(file, kFieldPath);
  CHECK(read.geometry.height_px == height);
  CHECK(read.geometry.width_px == width);
  CHECK(read.geometry.pitch_mm == 0.2);
  CHECK(read.model == engine::ModelKind::paper);
  CHECK(read.neighbourhood == 3);
  CHECK(std::ranges::equal(read.heights, field.view().heights));
}

TEST_CASE("the fields of both models are one plane, and say whose they are") {
  const engine::TextureField surface = random_surface(20, 17, 1);
  const Bytes file = engine::encode_field(surface.view());
  REQUIRE(file.size() == 64 + 20 * 17 * 4);
  CHECK(engine::encode_field(random_field(20, 17, 1).view()).size() == file.size());
  const engine::FieldView read = engine::decode_field(file, kFieldPath);
  CHECK(read.model == engine::ModelKind::surface);
  CHECK(read.highest == surface.view().highest);
  CHECK(std::ranges::equal(read.heights, surface.view().heights));
}

TEST_CASE("decoding a field and making its model read the header's page only") {
  const engine::TextureField field =
      GENERATE(0, 1) == 0 ? random_field(80, 90, 1) : random_surface(80, 90, 1);
  const Bytes file = engine::encode_field(field.view());
  GuardedBytes guarded(std::as_bytes(std::span(file)));
  guarded.leave_only({0});
  const engine::FieldView read = engine::decode_field(guarded.as<std::uint8_t>(), kFieldPath);
  engine::RenderingOptions options{.model = read.model};
  const engine::RenderingModel model(read, options, {0.01, 0.01, 0.01});
  engine::Bristle touch;
  CHECK(model.force_n({9.0, 8.0, 50.0}, {}, touch) == Vec3{});
  CHECK(guarded.pages() > 2);
}

TEST_CASE("the header says how high a field reaches") {
  const engine::TextureField field = random_field(9, 8, 3);
  float highest = 0.0F;
  for (const float height : field.view().heights) highest = std::max(highest, height);
  CHECK(engine::decode_field(engine::encode_field(field.view()), kFieldPath).highest ==
        double{highest});
  engine::FieldView unlooked = field.view();
  unlooked.highest = std::numeric_limits<double>::infinity();
  CHECK(engine::decode_field(engine::encode_field(unlooked), kFieldPath).highest ==
        double{highest});
}

TEST_CASE("decode_field refuses a field of the former version, and a height that is not a number") {
  const Bytes file = engine::encode_field(random_field(2, 3, 4).view());
  CHECK_THAT(refusal_of(with_value(file, 8, std::uint32_t{2})),
             names(kFieldPath.string() + " 2 3 touchtrial prepare"));
  CHECK_THAT(refusal_of(with_value(file, 32, std::nan(""))), names(kFieldPath.string()));
  for (const std::uint32_t side : {0U, 1U, 4U, 33U, 0xffffffffU}) {
    CHECK_THAT(refusal_of(with_value(file, 40, side)), names("3 31"));
  }
}

TEST_CASE("encode_field refuses a view that is not a whole field") {
  std::vector<float> heights(6);
  const auto with = [&](PlaneGeometry geometry) {
    return engine::FieldView{.geometry = geometry, .heights = heights};
  };
  CHECK_THROWS_AS(engine::encode_field({}), std::invalid_argument);
  CHECK_THROWS_AS(engine::encode_field(with({0.2, 2, 4})), std::invalid_argument);
  CHECK_THROWS_AS(engine::encode_field(with({0.2, -2, -3})), std::invalid_argument);
  CHECK_THROWS_AS(engine::encode_field(with({0.0, 2, 3})), std::invalid_argument);
  CHECK_THROWS_AS(engine::encode_field(with({std::nan(""), 2, 3})), std::invalid_argument);
  heights[4] = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_AS(engine::encode_field(with({0.2, 2, 3})), std::invalid_argument);
}

TEST_CASE("decode_field refuses a file that is cut anywhere or too long") {
  const Bytes file = engine::encode_field(random_field(2, 3, 3).view());
  for (std::size_t size = 0; size < file.size(); ++size) {
    const Bytes cut(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size));
    REQUIRE_THROWS_AS(engine::decode_field(cut, kFieldPath), FileError);
  }
  Bytes longer = file;
  longer.push_back(0);
  CHECK_THAT(refusal_of(longer), names(kFieldPath.string()));
}

TEST_CASE("decode_field refuses any other magic, version, layout and reserved byte") {
  const Bytes file = engine::encode_field(random_field(2, 3, 4).view());
  for (std::size_t at = 0; at < 64; ++at) {
    if (at >= 24 && at < 40) continue;  // pitch and highest point may be other numbers
    Bytes changed = file;
    changed[at] ^= 0x41U;
    CAPTURE(at);
    REQUIRE_THROWS_AS(engine::decode_field(changed, kFieldPath), FileError);
  }
}

TEST_CASE("decode_field refuses dimensions that are absurd, overflow or do not fit the file") {
  const Bytes file = engine::encode_field(random_field(2, 3, 5).view());
  const auto sized = [&](std::uint32_t height, std::uint32_t width) {
    return refusal_of(with_value(with_value(file, 16, height), 20, width));
  };
  CHECK_THAT(sized(0, 3), names("3 0"));
  CHECK_THAT(sized(0xffffffffU, 0xffffffffU), names("4294967295"));
  CHECK_THAT(sized(0x80000000U, 2), names("2 2147483648"));
  CHECK_THAT(sized((1U << 28U) + 1U, 1), names("1 268435457"));
  CHECK_THAT(sized(1U << 28U, 1), names(kFieldPath.string()) && !names("268435456"));
  CHECK_THAT(sized(3, 3), names(kFieldPath.string()));
}

TEST_CASE("decode_field refuses a pitch that is not a finite number above zero") {
  const Bytes file = engine::encode_field(random_field(2, 3, 6).view());
  const double pitch_mm = GENERATE(0.0, -0.2, std::numeric_limits<double>::infinity(),
                                   std::numeric_limits<double>::quiet_NaN());
  CHECK_THAT(refusal_of(with_value(file, 24, pitch_mm)), names(kFieldPath.string()));
}

const std::filesystem::path kManifestPath = "study.pack/pack.json";

engine::PackEntry entry(const std::string& code, std::uint8_t byte, engine::Gains gains) {
  engine::PackEntry made;
  made.code = code;
  made.checksum.fill(byte);
  made.input_tag.fill(static_cast<std::uint8_t>(byte + 1));
  made.gains = gains;
  return made;
}

engine::PackManifest two_entries() {
  return {
      "00ff",
      {entry("aaaaaaaaaaaaaaaa", 1, {0.1, 1.0 / 3.0}), entry("bbbbbbbbbbbbbbb2", 3, {1e-300, 0.0})},
      {0xab},
      {0xcd},
      {{1}, {2}},
      {0xef}};
}

/// A manifest's text with the first occurrence of one part replaced.
std::string with(const std::string& part, const std::string& other) {
  std::string text = engine::manifest_to_json(two_entries());
  const std::size_t at = text.find(part);
  REQUIRE(at != std::string::npos);
  return text.replace(at, part.size(), other);
}

std::string refusal_of(const std::string& text) {
  return message_of<FileError>([&] { return engine::manifest_from_json(text, kManifestPath); });
}

/// Whether a text is refused at these places.
bool is_refused(const std::string& text, const std::string& places) {
  const std::string message = refusal_of(text);
  UNSCOPED_INFO(message);
  return names(message, places);
}

TEST_CASE("a manifest's text has sorted keys and every key once") {
  const engine::PackManifest manifest{"00ff", {entry("aaaaaaaaaaaaaaaa", 1, {0.1, 0.5})}};
  CHECK(engine::manifest_to_json({"00ff", {}}) ==
        "{\n  \"fields\": [],\n  \"format\": \"touchtrial-pack\",\n  \"investigator_box\": \"" +
            std::string(64, '0') + "\",\n  \"pictures\": [],\n  \"seal\": \"" +
            std::string(64, '0') + "\",\n  \"signature\": \"" + std::string(128, '0') +
            "\",\n  \"study_id\": \"00ff\",\n  \"version\": 5\n}\n");
  CHECK(engine::manifest_to_json(manifest).find(
            "\"normal_n\": 0.5,\n        \"tangential_n\": 0.1\n") != std::string::npos);
}

TEST_CASE("manifest_from_json gives back what manifest_to_json was given, to the last bit") {
  const engine::PackManifest manifest = two_entries();
  CHECK(engine::manifest_from_json(engine::manifest_to_json(manifest), kManifestPath) == manifest);
}

TEST_CASE("a manifest has the same bytes and reading whatever the order of its entries") {
  engine::PackManifest reversed = two_entries();
  std::ranges::reverse(reversed.entries);
  CHECK(engine::manifest_to_json(reversed) == engine::manifest_to_json(two_entries()));
}

TEST_CASE("manifest_to_json refuses what it could not read back") {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::string code(16, 'a');
  CHECK_THROWS_AS(engine::manifest_to_json({"", {}}), std::invalid_argument);
  CHECK_THROWS_AS(engine::manifest_to_json({"bark", {}}), std::invalid_argument);
  CHECK_THROWS_AS(engine::manifest_to_json({"00", {entry("../../etc/passw", 1, {})}}),
                  std::invalid_argument);
  CHECK_THROWS_AS(engine::manifest_to_json({"00", {entry(code, 1, {infinity, 0.0})}}),
                  std::invalid_argument);
  CHECK_THROWS_AS(engine::manifest_to_json({"00", {entry(code, 1, {0.0, -1.0})}}),
                  std::invalid_argument);
  CHECK_THROWS_AS(engine::manifest_to_json({"00", {entry(code, 1, {}), entry(code, 2, {})}}),
                  std::invalid_argument);
}

TEST_CASE("manifest_from_json refuses a text cut anywhere") {
  const std::string text = engine::manifest_to_json(two_entries());
  for (std::size_t size = 0; size + 2 < text.size(); ++size) {
    REQUIRE_THROWS_AS(engine::manifest_from_json(text.substr(0, size), kManifestPath), FileError);
  }
}

TEST_CASE("manifest_from_json names the place of what it refuses") {
  struct Case {
    std::string part;
    std::string other;
    std::string places;
  };
  const auto tried = GENERATE(values<Case>({
      {"touchtrial-pack", "zip", "/format"},
      {"\"version\": 5", "\"version\": 4", "/version 5"},
      {"\"version\": 5", "\"version\": \"3\"", "/version"},
      {"\"version\": 5", "\"version\": 5, \"note\": 0", "/note"},
      {"\"version\": 5", "\"version\": 5, \"a/b~c\": 0", "/a~1b~0c"},
      {",\n  \"version\": 5", "", "/version"},
      {"\"00ff\"", "\"bark\"", "/study_id"},
      {"\"00ff\"", "17", "/study_id"},
      {"aaaaaaaaaaaaaaaa", "../aaaaaaaaaaaaa", "/fields/0/code 16"},
      {"aaaaaaaaaaaaaaaa", "aaaaaaa/aaaaaaaa", "/fields/0/code 16"},
      {"aaaaaaaaaaaaaaaa", "AAAAAAAAAAAAAAAA", "/fields/0/code 16"},
      {"aaaaaaaaaaaaaaaa", "aaaaaaaaaaaaaaa", "/fields/0/code 16"},
      {"aaaaaaaaaaaaaaaa", "aaaaaaaaaaaaaa\\u0000a", "/fields/0/code 16"},
      {"aaaaaaaaaaaaaaaa", "bbbbbbbbbbbbbbb2", "/fields/1/code"},
      {"0101", "01", "/fields/0/checksum 64"},
      {"0101", "01xx", "/fields/0/checksum 64"},
      {"\"0202", "\"", "/fields/0/input_tag 64"},
      {"\"input_tag\"", "\"label\"", "/fields/0/label"},
      {"0.1", "-0.1", "/fields/0/gains/tangential_n -0.1 0"},
      {"0.1", "null", "/fields/0/gains/tangential_n"},
      {"0.1", "true", "/fields/0/gains/tangential_n"},
      {"\"height_mm\": 0.0", "\"height_mm\": -1.0", "/fields/0/gains/height_mm -1 0"},
      {"\"height_mm\": 0.0,", "", "/fields/0/gains/height_mm"},
      {"0.1", "0.1, \"spring_n\": 1", "/fields/0/gains/spring_n"},
      {"\"ab00", "\"ab", "/seal 64"},
      {"\"cd00", "\"cd", "/investigator_box 64"},
      {"\"ef00", "\"ef", "/signature 128"},
      {"\"pictures\": [", "\"pictures\": [\"00\", ", "/pictures/0 64"},
      {"\"ab00", "\"AB00", ""},
      {"\"ef00", "\"eF00", ""},
      {"0.1", "1e-1", ""},
      {"0.1", "0.10000000000000000001", ""},
      {"\"fields\": [", "\"fields\":  [", ""},
      {"\"00ff\"", "\"00\\u0066f\"", ""},
  }));
  const std::string message = refusal_of(with(tried.part, tried.other));
  CAPTURE(message, tried.places);
  CHECK_THAT(message, names("study.pack/pack.json touchtrial prepare " + tried.places));
}

TEST_CASE("manifest_from_json refuses texts that are not manifests") {
  CHECK(is_refused("", "1"));
  CHECK(is_refused("[]", "study.pack/pack.json"));
  CHECK(is_refused("null", "study.pack/pack.json"));
  CHECK(is_refused("{} {}", "1 4"));
  CHECK(is_refused("{\"version\": 1e999}", "/version"));
  CHECK(is_refused("{\"\xff\": 1}", "1 3"));
  CHECK(is_refused(with("\"fields\": [", "\"fields\": 7, \"more\": ["), "/more"));
}

TEST_CASE("manifest_from_json refuses a key that is twice in one object") {
  CHECK(is_refused(with("\"version\": 5", "\"version\": 5, \"version\": 5"), "/version"));
  CHECK(is_refused(with("\"normal_n\"", "\"tangential_n\": 9, \"normal_n\""),
                   "/fields/0/gains/tangential_n"));
}

TEST_CASE("manifest_from_json survives endless nesting") {
  CHECK(is_refused(std::string(1000000, '['), "study.pack/pack.json"));
}

TEST_CASE("manifest_from_json keeps its message on one line") {
  const std::string message = refusal_of(with("\"version\"", "\"ver\\nsion\""));
  CHECK(message.find('\n') == std::string::npos);
  CHECK(refusal_of("{\n\"a\": \n x}").find('\n') == std::string::npos);
}

}  // namespace
}  // namespace touchtrial
