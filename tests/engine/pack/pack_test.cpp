#include "engine/pack/pack.hpp"

#include "core/errors.hpp"
#include "engine/rendering/sample_fields.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace touchtrial {
namespace {

const std::string kFirst = "abcdefgh234567aa";
const std::string kSecond = "0123456789abcdef";

/// A pack of two fields in a folder of its own.
struct SmallPack {
  SmallPack() {
    manifest.study_id = "0badcafe";
    add(kSecond, random_field(12, 9, 2));
    add(kFirst, random_field(12, 9, 1));
    engine::write_manifest(folder.path(), manifest);
  }

  void add(const std::string& code, const engine::TextureField& field) {
    engine::PackEntry entry;
    entry.code = code;
    entry.checksum = engine::write_field(folder.path(), code, field.view());
    entry.input_tag.fill(7);
    entry.gains = {0.011, 0.023};
    manifest.entries.push_back(entry);
  }

  [[nodiscard]] std::filesystem::path field(const std::string& code) const {
    return folder.path() / (code + ".field");
  }

  TempFolder folder;
  engine::PackManifest manifest;
};

TEST_CASE("is_pack_code accepts 16 lower-case letters and digits only") {
  CHECK(engine::is_pack_code(kFirst));
  CHECK(engine::is_pack_code(kSecond));
  CHECK_FALSE(engine::is_pack_code(""));
  CHECK_FALSE(engine::is_pack_code("abcdefgh234567a"));
  CHECK_FALSE(engine::is_pack_code("abcdefgh234567aaa"));
  CHECK_FALSE(engine::is_pack_code("ABCDEFGH234567AA"));
  CHECK_FALSE(engine::is_pack_code("../abcdefgh23456"));
  CHECK_FALSE(
      engine::is_pack_code("abcdefgh2345\xc3\xa4"
                           "aa"));
}

TEST_CASE("a pack read back has the manifest that was written") {
  const SmallPack made;
  const engine::Pack pack(made.folder.path());
  CHECK(pack.manifest() == made.manifest);
  CHECK(pack.folder() == made.folder.path());
  CHECK(pack.entry(kFirst).code == kFirst);
}

TEST_CASE("a mapped field has the heights that were written, aligned for any processor") {
  const SmallPack made;
  const engine::Pack pack(made.folder.path());
  const engine::TextureField original = random_field(12, 9, 1);
  const engine::MappedField mapped = pack.map(kFirst);
  const auto heights = mapped.view().heights;
  CHECK(std::ranges::equal(heights, original.view().heights));
  CHECK(std::bit_cast<std::uintptr_t>(heights.data()) % 64 == 0);
}

TEST_CASE("a mapped field keeps its heights when it is moved") {
  const SmallPack made;
  const engine::Pack pack(made.folder.path());
  engine::MappedField mapped = pack.map(kFirst);
  const float height = mapped.view().heights[5];
  const engine::MappedField moved = std::move(mapped);
  CHECK(moved.view().heights[5] == height);
}

TEST_CASE("a pack knows which of its fields were changed") {
  const SmallPack made;
  const engine::Pack pack(made.folder.path());
  CHECK(pack.is_intact(kFirst));
  Bytes content = read_file(made.field(kFirst));
  content.back() ^= 1U;
  replace_file(made.field(kFirst), ByteView(content));
  CHECK_FALSE(pack.is_intact(kFirst));
  CHECK(pack.is_intact(kSecond));
}

TEST_CASE("a pack's digest depends on everything that pack.json says, but the signature") {
  const SmallPack made;
  const Digest original = engine::Pack(made.folder.path()).digest();
  const auto digest_with = [&](auto change) {
    engine::PackManifest manifest = made.manifest;
    change(manifest);
    engine::write_manifest(made.folder.path(), manifest);
    return engine::Pack(made.folder.path()).digest();
  };
  CHECK(digest_with([](engine::PackManifest&) {}) == original);
  CHECK(digest_with([](engine::PackManifest& m) { m.study_id = "0badcaff"; }) != original);
  CHECK(digest_with([](engine::PackManifest& m) { m.entries[0].checksum[31] ^= 1U; }) != original);
  CHECK(digest_with([](engine::PackManifest& m) { m.entries[1].input_tag[0] ^= 1U; }) != original);
  CHECK(digest_with([](engine::PackManifest& m) { m.entries[1].code[15] = 'b'; }) != original);
  CHECK(digest_with([](engine::PackManifest& m) { m.entries.pop_back(); }) != original);
  CHECK(digest_with([](engine::PackManifest& m) {
          m.entries[0].gains.tangential_n = std::nextafter(0.011, 1.0);
        }) != original);
  CHECK(digest_with([](engine::PackManifest& m) {
          m.entries[0].gains.normal_n = std::nextafter(0.023, 1.0);
        }) != original);
  CHECK(digest_with([](engine::PackManifest& m) { m.entries[0].gains.height_mm = 1e-300; }) !=
        original);
  CHECK(digest_with([](engine::PackManifest& m) { m.seal[0] ^= 1U; }) != original);
  CHECK(digest_with([](engine::PackManifest& m) { m.investigator_box[0] ^= 1U; }) != original);
  CHECK(digest_with([](engine::PackManifest& m) { m.pictures.push_back({}); }) != original);
  CHECK(digest_with([](engine::PackManifest& m) { m.signature[0] ^= 1U; }) == original);
}

TEST_CASE("a pack refuses unknown codes, and paths in place of codes") {
  const SmallPack made;
  const engine::Pack pack(made.folder.path());
  CHECK_THROWS_AS(pack.entry("aaaaaaaaaaaaaaaa"), FileError);
  CHECK_THROWS_AS(pack.map("../" + kFirst), FileError);
  CHECK_THROWS_AS(pack.is_intact(""), FileError);
  CHECK_THROWS_AS(
      engine::write_field(made.folder.path(), "../escape", random_field(3, 3, 1).view()),
      std::invalid_argument);
}

TEST_CASE("a pack refuses a field file that is missing, cut or of another kind") {
  const SmallPack made;
  const engine::Pack pack(made.folder.path());
  std::filesystem::resize_file(made.field(kFirst), 100);
  CHECK_THROWS_AS(pack.map(kFirst), FileError);
  CHECK_FALSE(pack.is_intact(kFirst));
  replace_file(made.field(kFirst), std::string_view("not a field at all"));
  CHECK_THROWS_AS(pack.map(kFirst), FileError);
  std::filesystem::remove(made.field(kFirst));
  CHECK_THROWS_AS(pack.map(kFirst), FileError);
  CHECK_THROWS_AS(pack.is_intact(kFirst), FileError);
}

TEST_CASE("a missing pack is refused") {
  const TempFolder folder;
  CHECK_THROWS_AS(engine::Pack(folder.path()), FileError);
  CHECK_THROWS_AS(engine::Pack(folder.path() / "nowhere"), FileError);
  std::filesystem::create_directory(folder.path() / "pack.json");
  CHECK_THROWS_AS(engine::Pack(folder.path()), FileError);
}

TEST_CASE("write_field and write_manifest report a missing folder") {
  const TempFolder folder;
  const std::filesystem::path nowhere = folder.path() / "nowhere";
  CHECK_THROWS_AS(engine::write_field(nowhere, kFirst, random_field(3, 3, 1).view()), FileError);
  CHECK_THROWS_AS(engine::write_manifest(nowhere, {"00", {}}), FileError);
}

}  // namespace
}  // namespace touchtrial
