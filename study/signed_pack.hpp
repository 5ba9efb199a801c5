/// \file The investigator's signature of a pack, and its verification.
#pragma once

#include "engine/pack/pack.hpp"
#include "study/study_key.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::study {

/// The pictures that participants see, or feel in practice: the first of each class, those of
/// practice, and those of the instructions. Paths as in the study file, without duplicates.
[[nodiscard]] std::vector<std::filesystem::path> shown_pictures(const Study& study);

/// Hashes for PackManifest::pictures, one for each shown picture, over its path in the study file
/// and its bytes. Reads all pictures, on several threads.
/// \throws FileError if one cannot be read
[[nodiscard]] std::vector<Digest> picture_digests(const Study& study);

/// Adds the identity of the key's study to a manifest, and signs it.
/// \param manifest  with its entries
/// \param pictures  from picture_digests
void sign(engine::PackManifest& manifest, const StudyKey& key, std::vector<Digest> pictures);

/// Whether the holder of this public key signed the manifest.
[[nodiscard]] bool is_signed(const engine::PackManifest& manifest, const PublicKey& investigator);

/// Verifies that the investigator signed the manifest and gains for the sealed study, and that
/// every field has the prepared bytes. Reads all fields.
/// \throws FileError with the difference and the remedy
void require_signed(const engine::Pack& pack, const std::string& study_id, const Digest& seal,
                    const PublicKey& investigator);

/// Verifies that the shown pictures have not changed since the pack was made.
/// \param folders  where to look for them
/// \return the pictures that were not found, and therefore not compared
/// \throws FileError with the first picture that differs and the remedy
[[nodiscard]] std::vector<std::filesystem::path> require_pictures(
    const engine::Pack& pack, const Study& study, std::span<const std::filesystem::path> folders);

/// Verifies everything that a session needs: require_signed, the investigator's encryption key, and
/// every shown picture in the study's folder.
/// \throws FileError with the difference and the remedy
void require_complete_pack(const engine::Pack& pack, const StudyCodes& codes);

}  // namespace touchtrial::study
