/// \file The key of a study, which holds the meaning of the codes and the study's secrets. It is
/// stored as `<study>.key` with mode 0600. Format: docs/data-dictionary.md, "Key".
#pragma once

#include "core/cipher.hpp"
#include "protocols/design/schedule.hpp"
#include "protocols/design/study.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::design {

/// One code and its meaning.
struct KeyedStimulus {
  std::string code;
  StimulusIndex stimulus;
};

/// The public identity and the secrets of a study, and the study itself.
struct StudyKey {
  std::string study_id;  ///< hexadecimal; derived from `master`, reveals nothing about it
  SecretKey master{};
  SecretKey nonce{};
  Study study;                         ///< as sealed: labels, image names, methods, seed
  std::vector<KeyedStimulus> stimuli;  ///< every presented class x exemplar x method
  std::filesystem::path pack_folder;   ///< the pack's place when the key was written
  bool simulated = false;

  /// \return the stimulus with this code, or nothing if there is none
  [[nodiscard]] std::optional<StimulusIndex> stimulus_of(const std::string& code) const;
  /// \throws StudyError if the study does not present the stimulus
  [[nodiscard]] const std::string& code_of(const StimulusIndex& stimulus) const;
};

/// Makes a new key. `entropy` supplies the secrets, for the purposes "touchtrial study key master"
/// and "touchtrial study key nonce"; the codes are derived from the master secret. A code depends
/// only on the master secret, the class label, the image path as written and the method label, so a
/// stimulus keeps its code when others are added or removed.
/// \throws StudyError if two stimuli get the same code (probability 2^-64 for each pair)
[[nodiscard]] StudyKey make_study_key(const Study& study, Entropy& entropy, bool simulated);

/// Makes a key with the same secrets for a study file that has changed since.
[[nodiscard]] StudyKey rekeyed(const StudyKey& key, const Study& study);

/// Writes the key durably with mode 0600. The folders of study and pack are stored relative to the
/// key, so that all three can be moved together.
/// \throws FileError if the file cannot be written
void save_study_key(const std::filesystem::path& path, const StudyKey& key);

/// \throws FileError if the file is missing, is malformed, or has been altered since it was written
[[nodiscard]] StudyKey load_study_key(const std::filesystem::path& path);

/// Schedule and layout as the secret part of a session's opening event, with codes instead of
/// indices.
[[nodiscard]] std::string schedule_to_json(const Schedule& schedule, const StudyKey& key);
/// \throws StoreError if the text is not a schedule, or names a code that the key does not have
[[nodiscard]] Schedule schedule_from_json(const std::string& text, const StudyKey& key);

/// A restarted block as the secret part of its event, in the form of a schedule's presentations.
[[nodiscard]] std::string block_to_json(const std::vector<Presentation>& block,
                                        const StudyKey& key);
/// \throws StoreError if the text is not a block, or names a code that the key does not have
[[nodiscard]] std::vector<Presentation> block_from_json(const std::string& text,
                                                        const StudyKey& key);

/// The code of the plane without texture. It is derived from the key like the code of a stimulus,
/// so that it looks the same. No pack has a field with this code.
[[nodiscard]] std::string catch_code(const StudyKey& key);

/// The study as a database stores it in clear: with codes instead of labels and image names, sorted
/// by code, and without the seed, from which the schedule could be computed. It has the settings of
/// practice and session without their texts, and a keyed hash of practice, session and registration
/// as a whole. Compact JSON.
[[nodiscard]] std::string blinded_configuration(const StudyKey& key);

/// The study's seal, which is written before trial 1: SHA-256 over key (master secret, whether it
/// is simulated, meaning of each code), schedule rule, seed, blinded configuration and nonce. The
/// study's folder and the layout of its file do not enter.
[[nodiscard]] Digest study_seal(const StudyKey& key);

}  // namespace touchtrial::design
