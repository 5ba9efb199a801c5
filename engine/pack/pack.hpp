/// \file A study's prepared force fields under opaque names: `<study>.pack/`.
/// Format: docs/data-dictionary.md, "Pack".
#pragma once

#include "core/files.hpp"
#include "core/hash.hpp"
#include "engine/rendering/texture_field.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::engine {

/// One field of a pack. Nothing here tells what it shows.
struct PackEntry {
  std::string code;    ///< opaque name, see is_pack_code; the file is <code>.field
  Digest checksum{};   ///< SHA-256 of the file
  Digest input_tag{};  ///< keyed hash of everything that decides the field; without the key, noise
  Gains gains;         ///< finite, >= 0

  friend bool operator==(const PackEntry&, const PackEntry&) = default;
};

/// The pack's table of contents, `pack.json`.
struct PackManifest {
  std::string study_id;            ///< the key's public identity, hexadecimal
  std::vector<PackEntry> entries;  ///< sorted by code, no code twice

  friend bool operator==(const PackManifest&, const PackManifest&) = default;
};

/// Whether a text may name a field: 16 lower-case letters and digits, which base32 and hexadecimal
/// both are, so that no code can be a path.
[[nodiscard]] bool is_pack_code(std::string_view code) noexcept;

/// Writes one field file durably; its size depends on height, width and model alone. Write the
/// fields of a pack in the order of their codes, so that the files' times tell nothing either.
/// \return its SHA-256
/// \throws FileError if it cannot be written; std::invalid_argument if the code is none, or the
///   view is empty or has another number of samples than its geometry, heights that are not finite,
///   or more than kMaxImagePixels
Digest write_field(const std::filesystem::path& folder, const std::string& code, FieldView field);

/// Writes `pack.json` durably, after the fields it names; entries may come in any order. The same
/// manifest gives the same bytes.
/// \throws FileError if it cannot be written; std::invalid_argument if study_id is not hexadecimal,
///   a code is none or occurs twice, or a gain is negative or not finite
void write_manifest(const std::filesystem::path& folder, const PackManifest& manifest);

/// A field mapped from a pack; keep it as long as its view is used.
class MappedField {
 public:
  explicit MappedField(MappedFile file, FieldView view) : file_(std::move(file)), view_(view) {}
  [[nodiscard]] FieldView view() const noexcept { return view_; }

 private:
  MappedFile file_;
  FieldView view_;
};

/// A pack on disk, opened read-only. Any number of threads may use one.
class Pack {
 public:
  /// Reads the table of contents only.
  /// \throws FileError if the folder or pack.json is missing, truncated or malformed
  explicit Pack(std::filesystem::path folder);

  [[nodiscard]] const PackManifest& manifest() const noexcept { return manifest_; }
  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }

  /// SHA-256 over the canonical table of contents: what a database remembers of its pack. It
  /// depends on what pack.json says and not on how it is laid out.
  [[nodiscard]] Digest digest() const;

  /// The entry of a code. \throws FileError if the pack has none such
  [[nodiscard]] const PackEntry& entry(const std::string& code) const;

  /// Maps a field; header and size are checked, content pages are read when touched. Samples are
  /// what the file holds: only is_intact tells whether they are what was written.
  /// \throws FileError if the file is missing, truncated or not a field
  [[nodiscard]] MappedField map(const std::string& code) const;

  /// Whether a field's bytes still have their checksum. \throws FileError if it cannot be read
  [[nodiscard]] bool is_intact(const std::string& code) const;

 private:
  std::filesystem::path folder_;
  PackManifest manifest_;
};

}  // namespace touchtrial::engine
