/// \file The secret files of a study. The investigator's `<study>.key` decrypts everything. A
/// station's `<study>.station` suffices to run sessions with the station's participants, but cannot
/// decrypt sessions that have ended. Formats: docs/data-dictionary.md, "Key" and "Station file".
#pragma once

#include "core/public_keys.hpp"
#include "study/schedule.hpp"
#include "study/station.hpp"
#include "study/study.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::study {

/// One code and its meaning.
struct KeyedStimulus {
  std::string code;
  StimulusIndex stimulus;
};

/// The content common to both files: the study, the meaning of its codes, and its public identity.
struct StudyCodes {
  std::string study_id;  ///< hexadecimal; derived from the master secret without revealing it
  Study study;           ///< as sealed: labels, image names, methods
  std::vector<KeyedStimulus> stimuli;   ///< every presented class x exemplar x method
  std::vector<KeyedStimulus> practice;  ///< practice textures, which no schedule contains
  /// The code of the plane without texture. It looks like the code of a stimulus, but no pack has a
  /// field with this code.
  std::string catch_code;
  std::string configuration;           ///< see blinded_configuration
  Digest seal{};                       ///< see study_seal
  PublicKey investigator_box{};        ///< encrypts for the investigator
  PublicKey investigator_signature{};  ///< verifies the investigator's signatures
  std::filesystem::path pack_folder;   ///< the pack's folder when the file was written
  bool simulated = false;

  /// All fields of the study's pack: `stimuli`, then `practice`.
  [[nodiscard]] std::vector<KeyedStimulus> fields() const;
  /// \return the stimulus with this code, or nothing if there is none
  [[nodiscard]] std::optional<StimulusIndex> stimulus_of(const std::string& code) const;
  /// The code of a field.
  /// \throws StudyError if the study does not present the stimulus
  [[nodiscard]] const std::string& code_of(const StimulusIndex& stimulus) const;
};

/// The investigator's key.
struct StudyKey : StudyCodes {
  SecretKey master{};
  std::vector<Station> stations;  ///< with their secrets; never empty

  /// The random input of a participant's schedule, for an enrolment number of any station.
  /// \throws UsageError if no station has the number, or the study has no such visit
  [[nodiscard]] ScheduleDraw draw_of(int enrolment, Draws draws, int visit = 1) const;
  /// The group of an enrolment number, as group_for; also empty if no station has the number.
  [[nodiscard]] std::optional<int> group_of(int enrolment, Draws draws) const;
  [[nodiscard]] BoxKeys box() const;
  [[nodiscard]] Signer signer() const;
};

/// One station's file.
struct StationKey : StudyCodes {
  Station station;
  /// The investigator's signature under station_statement.
  Signature certificate{};

  /// \throws UsageError if the number is not the station's, or the study has no such visit
  [[nodiscard]] ScheduleDraw draw_of(int enrolment, Draws draws, int visit = 1) const;
  [[nodiscard]] Signer signer() const;
};

/// Makes a new key with one station. `entropy` supplies the master secret, for the purpose
/// "touchtrial study key master"; all other secrets and the codes are derived from it. A code
/// depends only on the master secret, the class label, the image path as written, the method label,
/// and whether the stimulus is for practice. A stimulus therefore keeps its code when others are
/// added or removed, and a practice texture that becomes a class gets a new code.
/// \throws StudyError if two stimuli get the same code (probability 2^-64 for each pair)
[[nodiscard]] StudyKey make_study_key(const Study& study, Entropy& entropy, bool simulated);

/// The key of a study's simulations and rehearsals. Its secrets are derived from the study's seed,
/// so that simulated databases of one study belong together and can be reproduced. No real study
/// uses them.
[[nodiscard]] StudyKey simulated_study_key(const Study& study);

/// Makes a key with the same secrets and stations for a changed study file.
[[nodiscard]] StudyKey rekeyed(const StudyKey& key, const Study& study);

/// Replaces the stations of the key, and derives a secret for each new station.
void assign_stations(StudyKey& key, std::vector<Station> stations);

/// The file of one of the key's stations.
/// \throws UsageError with the names of the existing stations, if no station has this name
[[nodiscard]] StationKey station_key(const StudyKey& key, const std::string& name);

/// Writes the file durably with mode 0600. The folders of study and pack are stored relative to the
/// file, so that all three can be moved together.
/// \throws FileError if the file cannot be written
void save_study_key(const std::filesystem::path& path, const StudyKey& key);
void save_station_key(const std::filesystem::path& path, const StationKey& key);

/// \throws FileError if the file is missing, is malformed, has been altered since it was written,
///   or can be read by others
[[nodiscard]] StudyKey load_study_key(const std::filesystem::path& path);
[[nodiscard]] StationKey load_station_key(const std::filesystem::path& path);

/// Schedule and layout as the secret part of a session's opening event, with codes instead of
/// indices.
[[nodiscard]] std::string schedule_to_json(const Schedule& schedule, const StudyCodes& codes);
/// \throws StoreError if the text is not a schedule, or names a code that the key does not have
[[nodiscard]] Schedule schedule_from_json(const std::string& text, const StudyCodes& codes);

/// A restarted block as the secret part of its event, in the form of a schedule's trials.
[[nodiscard]] std::string block_to_json(const std::vector<Trial>& block, const StudyCodes& codes);
/// \throws StoreError if the text is not a block, or names a code that the key does not have
[[nodiscard]] std::vector<Trial> block_from_json(const std::string& text, const StudyCodes& codes);

/// The study as stored unencrypted in a database: with codes instead of labels and image names,
/// sorted by code, and without the seed. It has the settings of practice and session without their
/// texts, and a keyed hash of all of practice, session and registration. Compact JSON.
[[nodiscard]] std::string blinded_configuration(const StudyKey& key);

/// Whether two studies are equal, regardless of the place and layout of their files.
[[nodiscard]] bool are_same(const Study& a, const Study& b);

/// Explains why a key or station file does not belong to a study, with the remedy. The message
/// names the file's study or, if that has the same name, the parts that differ.
/// \param study  as read from its file
/// \param file  the file of `key`
/// \param option  command-line option that selects the file, for instance "--key"
[[nodiscard]] std::string mismatch_of(const Study& study, const StudyCodes& key,
                                      const std::filesystem::path& file, const std::string& option);

/// The study's seal, which is recorded before trial 1: SHA-256 over key (master secret, whether it
/// is simulated, meaning of each code), schedule rule, seed and blinded configuration. It covers
/// the codes of practice through the master secret and the keyed hash of the practice section. It
/// does not depend on the study's folder, the layout of its file or its stations.
[[nodiscard]] Digest study_seal(const StudyKey& key);

}  // namespace touchtrial::study
