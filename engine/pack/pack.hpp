/// \file A pack: a study's prepared force fields under opaque names, `<study>.pack/`.
/// Format: docs/data-dictionary.md, "Pack".
#pragma once

#include "core/files.hpp"
#include "core/public_keys.hpp"
#include "engine/rendering/texture_field.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::engine {

/// One field of a pack. Its entry does not reveal the texture.
struct PackEntry {
  std::string code;    ///< opaque name (is_pack_code); the file is <code>.field
  Digest checksum{};   ///< SHA-256 of the file
  Digest input_tag{};  ///< keyed hash of all inputs of the field; indistinguishable from noise
                       ///< without the key
  Gains gains;         ///< finite, >= 0

  friend bool operator==(const PackEntry&, const PackEntry&) = default;
};

/// The pack's table of contents, `pack.json`.
struct PackManifest {
  std::string study_id;            ///< the key's public identity, hexadecimal
  std::vector<PackEntry> entries;  ///< sorted by code, no code twice
  Digest seal{};                   ///< of the study when the pack was made
  PublicKey investigator_box{};    ///< seals for the investigator
  /// Digests of the pictures that participants see, and feel in practice. Sorted, so that their
  /// order reveals nothing about codes.
  std::vector<Digest> pictures{};
  Signature signature{};  ///< of digest_of(), by the investigator

  friend bool operator==(const PackManifest&, const PackManifest&) = default;
};

/// SHA-256 over the table of contents without the signature. The investigator signs it, and it
/// identifies the pack in a database.
[[nodiscard]] Digest digest_of(const PackManifest& manifest);

/// Whether a text is a valid code: 16 lower-case letters and digits, so that no code can be a path.
[[nodiscard]] bool is_pack_code(std::string_view code) noexcept;

/// Writes one field file durably; its size depends only on height, width and model. Write the
/// fields of a pack in the order of their codes, so that file times reveal nothing.
/// \return its SHA-256
/// \throws FileError if it cannot be written
/// \throws std::invalid_argument if the code is invalid (is_pack_code), or the view is empty, has
///   more than kMaxImagePixels or non-finite heights, or does not fill its geometry
Digest write_field(const std::filesystem::path& folder, const std::string& code, FieldView field);

/// Writes `pack.json` durably; call it after writing the fields it names. Entries may come in any
/// order. The same manifest gives the same bytes.
/// \throws FileError if it cannot be written
/// \throws std::invalid_argument if study_id is not hexadecimal, a code is invalid or occurs twice,
///   or a gain is negative or not finite
void write_manifest(const std::filesystem::path& folder, const PackManifest& manifest);

/// A field mapped from a pack; it must outlive every use of its view.
class MappedField {
 public:
  explicit MappedField(MappedFile file, FieldView view) : file_(std::move(file)), view_(view) {}
  [[nodiscard]] FieldView view() const noexcept { return view_; }

 private:
  MappedFile file_;
  FieldView view_;
};

/// Maps a field's file. Checks header and size. Samples are read on access, and only verified by
/// the checksum.
/// \throws FileError if the file is missing, truncated or not a field
[[nodiscard]] MappedField map_field(const std::filesystem::path& file);

/// A pack on disk, opened read-only. Thread-safe.
class Pack {
 public:
  /// Reads the table of contents only.
  /// \throws FileError if the folder or pack.json is missing, truncated or malformed
  explicit Pack(std::filesystem::path folder);

  [[nodiscard]] const PackManifest& manifest() const noexcept { return manifest_; }
  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }

  /// digest_of() the manifest.
  [[nodiscard]] Digest digest() const { return digest_of(manifest_); }

  /// The entry of a code.
  /// \throws FileError if the pack has no such code
  [[nodiscard]] const PackEntry& entry(const std::string& code) const;

  /// Maps the field of a code.
  [[nodiscard]] MappedField map(const std::string& code) const;

  /// Whether a field's file matches its checksum.
  /// \throws FileError if the file cannot be read
  [[nodiscard]] bool is_intact(const std::string& code) const;

 private:
  std::filesystem::path folder_;
  PackManifest manifest_;
};

}  // namespace touchtrial::engine
