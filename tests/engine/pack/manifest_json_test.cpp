#include "engine/pack/manifest_json.hpp"

#include "core/errors.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace touchtrial {
namespace {

const std::filesystem::path kName = "study.pack/pack.json";

engine::PackEntry entry(const std::string& code, std::uint8_t byte, engine::Gains gains) {
  engine::PackEntry made;
  made.code = code;
  made.checksum.fill(byte);
  made.input_tag.fill(static_cast<std::uint8_t>(byte + 1));
  made.gains = gains;
  return made;
}

engine::PackManifest two_entries() {
  return {"00ff",
          {entry("aaaaaaaaaaaaaaaa", 1, {0.1, 1.0 / 3.0}),
           entry("bbbbbbbbbbbbbbb2", 3, {1e-300, 0.0})}};
}

/// A manifest's text with the first occurrence of one part replaced.
std::string with(const std::string& part, const std::string& other) {
  std::string text = engine::manifest_to_json(two_entries());
  const std::size_t at = text.find(part);
  REQUIRE(at != std::string::npos);
  return text.replace(at, part.size(), other);
}

std::string refusal_of(const std::string& text) {
  try {
    static_cast<void>(engine::manifest_from_json(text, kName));
  } catch (const FileError& error) {
    return error.what();
  }
  return "accepted";
}

/// Whether a text is refused for a reason that holds these words.
bool is_refused(const std::string& text, const std::string& words) {
  const std::string message = refusal_of(text);
  UNSCOPED_INFO(message);
  return message.find(words) != std::string::npos;
}

TEST_CASE("a manifest's text has sorted keys and says everything once") {
  const engine::PackManifest manifest{"00ff", {entry("aaaaaaaaaaaaaaaa", 1, {0.1, 0.5})}};
  CHECK(engine::manifest_to_json({"00ff", {}}) ==
        "{\n  \"fields\": [],\n  \"format\": \"touchtrial-pack\",\n  \"study_id\": \"00ff\",\n"
        "  \"version\": 2\n}\n");
  CHECK(engine::manifest_to_json(manifest).find(
            "\"normal_n\": 0.5,\n        \"tangential_n\": 0.1\n") != std::string::npos);
}

TEST_CASE("manifest_from_json gives back what manifest_to_json was given, to the last bit") {
  const engine::PackManifest manifest = two_entries();
  CHECK(engine::manifest_from_json(engine::manifest_to_json(manifest), kName) == manifest);
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
    REQUIRE_THROWS_AS(engine::manifest_from_json(text.substr(0, size), kName), FileError);
  }
}

TEST_CASE("manifest_from_json names the place of what it refuses") {
  struct Case {
    std::string part;
    std::string other;
    std::string expected;
  };
  const auto tried = GENERATE(values<Case>({
      {"touchtrial-pack", "zip", "/format: must be"},
      {"\"version\": 2", "\"version\": 1", "/version: is not 2"},
      {"\"version\": 2", "\"version\": \"2\"", "/version: is not 2"},
      {"\"version\": 2", "\"version\": 2, \"note\": 0", "/note: is not a key"},
      {"\"version\": 2", "\"version\": 2, \"a/b~c\": 0", "/a~1b~0c: is not a key"},
      {",\n  \"version\": 2", "", "/version: is missing"},
      {"\"00ff\"", "\"bark\"", "/study_id: must be hexadecimal"},
      {"\"00ff\"", "17", "/study_id: must be a string"},
      {"aaaaaaaaaaaaaaaa", "../aaaaaaaaaaaaa", "/fields/0/code: must be 16"},
      {"aaaaaaaaaaaaaaaa", "aaaaaaa/aaaaaaaa", "/fields/0/code: must be 16"},
      {"aaaaaaaaaaaaaaaa", "AAAAAAAAAAAAAAAA", "/fields/0/code: must be 16"},
      {"aaaaaaaaaaaaaaaa", "aaaaaaaaaaaaaaa", "/fields/0/code: must be 16"},
      {"aaaaaaaaaaaaaaaa", "aaaaaaaaaaaaaa\\u0000a", "/fields/0/code: must be 16"},
      {"aaaaaaaaaaaaaaaa", "bbbbbbbbbbbbbbb2", "/fields/1/code: stands in the manifest twice"},
      {"0101", "01", "/fields/0/checksum: must be 64"},
      {"0101", "01xx", "/fields/0/checksum: must be 64"},
      {"\"0202", "\"", "/fields/0/input_tag: must be 64"},
      {"\"input_tag\"", "\"label\"", "/fields/0/label: is not a key"},
      {"0.1", "-0.1", "/fields/0/gains/tangential_n: must be a number >= 0"},
      {"0.1", "null", "/fields/0/gains/tangential_n: must be a number >= 0"},
      {"0.1", "true", "/fields/0/gains/tangential_n: must be a number >= 0"},
      {"\"height_mm\": 0.0", "\"height_mm\": -1.0", "/fields/0/gains/height_mm: must be a number"},
      {"\"height_mm\": 0.0,", "", "/fields/0/gains/height_mm: is missing"},
      {"0.1", "0.1, \"spring_n\": 1", "/fields/0/gains/spring_n: is not a key"},
  }));
  const std::string message = refusal_of(with(tried.part, tried.other));
  CAPTURE(message, tried.expected);
  CHECK(message.find("study.pack/pack.json: " + tried.expected) == 0);
  CHECK(message.find("touchtrial prepare") != std::string::npos);
}

TEST_CASE("manifest_from_json refuses what is no manifest at all") {
  CHECK(is_refused("", "is not valid JSON"));
  CHECK(is_refused("[]", "must be an object"));
  CHECK(is_refused("null", "must be an object"));
  CHECK(is_refused("{} {}", "is not valid JSON"));
  CHECK(is_refused("{\"version\": 1e999}", "is not valid JSON"));
  CHECK(is_refused("{\"\xff\": 1}", "is not valid JSON"));
  CHECK(is_refused(with("\"fields\": [", "\"fields\": 7, \"more\": ["), "/more: is not a key"));
}

TEST_CASE("manifest_from_json refuses a key that stands twice in one object") {
  CHECK(is_refused(with("\"version\": 2", "\"version\": 2, \"version\": 2"),
                   "has the key \"version\" twice"));
  CHECK(is_refused(with("\"normal_n\"", "\"tangential_n\": 9, \"normal_n\""),
                   "has the key \"tangential_n\" twice"));
}

TEST_CASE("manifest_from_json survives nesting without end") {
  CHECK(is_refused(std::string(1000000, '['), "nested too deeply"));
}

TEST_CASE("manifest_from_json keeps its message on one line") {
  const std::string message = refusal_of(with("\"version\"", "\"ver\\nsion\""));
  CHECK(message.find('\n') == std::string::npos);
  CHECK(refusal_of("{\n\"a\": \n x}").find('\n') == std::string::npos);
}

}  // namespace
}  // namespace touchtrial
