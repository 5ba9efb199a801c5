#include "engine/pack/pack.hpp"

#include "core/errors.hpp"
#include "engine/pack/pack_files.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <stdexcept>
#include <system_error>

namespace touchtrial::engine {
namespace {

constexpr std::size_t kCodeLength = 16;
constexpr std::uintmax_t kMaxManifestBytes = std::uintmax_t{1} << 26;
constexpr const char* kManifestName = "pack.json";

std::filesystem::path field_path(const std::filesystem::path& folder, const std::string& code) {
  return folder / (code + ".field");
}

PackManifest read_manifest(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / kManifestName;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw FileError(one_line(path.string()) +
                    ": does not exist; make the pack with `touchtrial prepare STUDY`");
  }
  return manifest_from_json(text_of(ByteView(read_file(path, kMaxManifestBytes))), path);
}

}  // namespace

bool is_pack_code(std::string_view code) noexcept {
  return code.size() == kCodeLength && std::ranges::all_of(code, [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
         });
}

Digest write_field(const std::filesystem::path& folder, const std::string& code, FieldView field) {
  if (!is_pack_code(code)) {
    throw std::invalid_argument("write_field: a code is 16 lower-case letters and digits");
  }
  const Bytes file = encode_field(field);
  replace_file(field_path(folder, code), ByteView(file));
  return sha256(file);
}

void write_manifest(const std::filesystem::path& folder, const PackManifest& manifest) {
  replace_file(folder / kManifestName, std::string_view(manifest_to_json(manifest)));
}

Pack::Pack(std::filesystem::path folder)
    : folder_(std::move(folder)), manifest_(read_manifest(folder_)) {}

Digest digest_of(const PackManifest& manifest) {
  FieldHasher hasher;
  hasher.add("touchtrial pack 3").add(manifest.study_id);
  hasher.add(ByteView(manifest.seal)).add(ByteView(manifest.investigator_box));
  hasher.add(static_cast<std::int64_t>(manifest.entries.size()));
  for (const PackEntry& entry : manifest.entries) {
    hasher.add(entry.code).add(ByteView(entry.checksum)).add(ByteView(entry.input_tag));
    for (const NamedGain& gain : kGains) {
      hasher.add(std::bit_cast<std::int64_t>(entry.gains.*gain.value));
    }
  }
  for (const Digest& picture : manifest.pictures) hasher.add(ByteView(picture));
  return hasher.finish();
}

MappedField map_field(const std::filesystem::path& path) {
  MappedFile file(path);
  const FieldView view = decode_field(file.bytes(), path);
  return MappedField(std::move(file), view);
}

const PackEntry& Pack::entry(const std::string& code) const {
  const auto match = std::ranges::lower_bound(manifest_.entries, code, {}, &PackEntry::code);
  if (match == manifest_.entries.end() || match->code != code) {
    throw FileError(one_line((folder_ / kManifestName).string()) + ": /fields: has no field " +
                    one_line(code) + "; use the pack and key that were made together");
  }
  return *match;
}

MappedField Pack::map(const std::string& code) const {
  return map_field(field_path(folder_, entry(code).code));
}

bool Pack::is_intact(const std::string& code) const {
  const PackEntry& expected = entry(code);
  return sha256_of_file(field_path(folder_, expected.code)) == expected.checksum;
}

}  // namespace touchtrial::engine
