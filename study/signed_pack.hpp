/// \file What the investigator signs of a pack, and how a pack is held against it.
#pragma once

#include "engine/pack/pack.hpp"
#include "study/study_key.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::study {

/// The pictures that participants see or, in practice, feel: the first of each class, those of
/// practice, and those of the instructions. Paths as in the study file, no path twice.
[[nodiscard]] std::vector<std::filesystem::path> shown_pictures(const Study& study);

/// What PackManifest::pictures has of them: each is a hash of the path as in the study file and of
/// the file's bytes. Reads all of them, on several threads.
/// \throws FileError if one cannot be read
[[nodiscard]] std::vector<Digest> picture_digests(const Study& study);

/// Makes the manifest one of the key's study: fills in what identifies it, and signs it.
/// \param manifest  with its fields
/// \param pictures  as picture_digests
void sign(engine::PackManifest& manifest, const StudyKey& key, std::vector<Digest> pictures);

/// Whether the holder of this public half signed the manifest.
[[nodiscard]] bool is_signed(const engine::PackManifest& manifest, const PublicKey& investigator);

/// Holds a pack against its study: list and gains were signed by the investigator for the study as
/// it was sealed, and every field has the bytes that were prepared. Reads all fields.
/// \throws FileError with what differs and the remedy
void require_signed(const engine::Pack& pack, const std::string& study_id, const Digest& seal,
                    const PublicKey& investigator);

/// The shown pictures are those of the time when the pack was made.
/// \param folders  where they may lie
/// \return those that lie in none of the folders, and were not compared
/// \throws FileError with the first picture that differs and the remedy
[[nodiscard]] std::vector<std::filesystem::path> require_pictures(
    const engine::Pack& pack, const Study& study, std::span<const std::filesystem::path> folders);

/// All that a session presents, or a check before it: require_signed, the half of the key that
/// seals for the investigator, and every shown picture, in the study's folder.
/// \throws FileError with what differs and the remedy
void require_whole(const engine::Pack& pack, const StudyCodes& codes);

}  // namespace touchtrial::study
