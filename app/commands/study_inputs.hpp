/// \file Inputs of several commands: the keys of databases, the packs of studies, subject models.
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "analysis/report/results.hpp"
#include "app/commands/heads.hpp"
#include "protocols/simulation/stimulus_levels.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "record/personal_data.hpp"
#include "record/study_store.hpp"
#include "study/prepare.hpp"
#include "study/study_key.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::app {

/// The key file of a database: `explicit_path`, or `<db>.key` beside it if `explicit_path` is
/// empty.
[[nodiscard]] std::filesystem::path key_path_for(const std::filesystem::path& database,
                                                 const std::filesystem::path& explicit_path);

/// The path of the key that was last used for a database, stored in the user's configuration
/// folder (touchtrial/keys.json, readable only by the user).
/// \return empty if none is stored
[[nodiscard]] std::filesystem::path remembered_key(const std::filesystem::path& database);

/// The path of the key that key_of_database loads: key_path_for, or, if that is not given and does
/// not exist, the remembered one.
[[nodiscard]] std::filesystem::path key_in_use(const std::filesystem::path& database,
                                               const std::filesystem::path& explicit_path);

/// Loads the key at key_in_use, checks that it belongs to the database, and remembers its path. Its
/// pack_folder is that of study::find_pack.
/// \param database  a file, or the address of a study, which has no key beside it
/// \throws FileError if the key is missing or damaged
/// \throws VerificationError, naming both files, if the key is not the database's
[[nodiscard]] study::StudyKey key_of_database(const record::StudyStore& store,
                                              const std::filesystem::path& database,
                                              const std::filesystem::path& explicit_path);

/// analysis::load_outcomes, with the wording of the built-in questions.
[[nodiscard]] analysis::Outcomes outcomes_of(const record::StudyStore& store,
                                             const study::StudyKey& key,
                                             const std::string& participant = {});

/// All consents in the personal data beside a database.
/// \throws FileError if others may read the personal data
/// \throws StoreError if they cannot be read
[[nodiscard]] std::vector<record::PersonalRecord> consents_beside(
    const std::filesystem::path& database);

/// Why outcomes are not shown: the study is "not unblinded", or only the registered question is.
[[nodiscard]] std::string blind_words(const record::StudyState& state);

/// Loads the file of a database's station. Refuses a protected file of another station before
/// asking for its passphrase.
/// \throws StoreError with the remedy if the file's unencrypted part names another station
/// \throws FileError as load_station_key
[[nodiscard]] study::StationKey station_key_for(const record::StudyCommitment& commitment,
                                                const std::filesystem::path& database,
                                                const std::filesystem::path& file);

/// The signing files from the command line; empty paths: none.
struct SigningFiles {
  std::filesystem::path key;
  std::filesystem::path station;
  std::string accept_loss;  ///< as HeadOptions::accept_loss
};

/// Enables recording on the file's chain, and signs with the first of these: the investigator's key
/// or the station's file that the user named; the key beside the database; the file of the
/// database's station in the folder of the database or in the current folder; the remembered key.
/// An existing head file is kept up to date.
/// \throws FileError if a named file is missing or damaged
/// \throws StoreError with the remedy if there is no file, or it is not the database's
/// \throws as set_head_writer
void sign_with_files(record::StudyStore& store, const std::filesystem::path& database,
                     const SigningFiles& files);

/// Opens a database for recording, with sign_with_files.
/// \throws as StudyStore::open and sign_with_files
[[nodiscard]] record::StudyStore open_for_recording(const std::filesystem::path& database,
                                                    const SigningFiles& files);

/// Prints the new head after recording, if the database has a head file.
void print_head(const record::StudyStore& store, const std::filesystem::path& database);

/// The pack and key of a prepared study.
/// \param pack  the pack's folder; empty: `<study>.pack` beside the study file
[[nodiscard]] study::PackPlace pack_place_for(const std::filesystem::path& study_file,
                                              const std::filesystem::path& pack);

/// Writes the files of all stations beside the key.
void save_station_files(const study::StudyKey& key, const study::PackPlace& place);

/// The key of a simulated study. Its secrets are derived from the study's seed, so that its
/// databases belong together and can be reproduced. Its pack is at simulated_pack_place.
[[nodiscard]] study::StudyKey simulated_key(const study::Study& study,
                                            const std::filesystem::path& study_file);

/// \return the number of threads for levels: one for each core
[[nodiscard]] int cores();

/// study::prepare_pack with a progress bar, also for a study that states its level.
[[nodiscard]] study::PrepareReport prepare_with_progress(const study::PackLock& lock,
                                                         const study::StudyKey& key,
                                                         study::PrepareOptions options);

/// Completes the key's pack, with a progress bar, and prints the warnings. Waits while another
/// process prepares the pack.
/// \throws as plane_of and prepare_pack
void prepare_simulated_pack(const study::StudyKey& key);

/// The levels of a study's stimuli (docs/perception.md), on its device or, if it names none, on all
/// built-in device models, computed on all cores.
/// \throws FileError if the key's pack is missing or lacks a stimulus
/// \throws StudyError if the study names an unknown device
[[nodiscard]] simulation::StimulusLevels levels_of_pack(const study::StudyCodes& key);

/// Adds those levels to the results if the key's pack exists; a warning states why they could not
/// be computed.
/// \throws StudyError as levels_of_pack
[[nodiscard]] std::unique_ptr<const analysis::Results> with_levels(
    std::unique_ptr<const analysis::Results> results, const study::StudyKey& key);

/// Refuses to overwrite another key, which may be the only copy. The same key may remain after its
/// database was removed.
/// \throws StoreError if another key is at `path`
void refuse_other_key(const std::filesystem::path& path, const study::StudyKey& key);

/// \param path  a subject model; empty: the built-in one
/// \param hand_device  device of the simulated hand, as device::model_of_device; empty: the study's,
///   or ideal
/// \throws as load_subject_model, SubjectModel::check_labels, device::model_of_device and
///   simulation::device_of
[[nodiscard]] simulation::SubjectModel subject_for(const std::filesystem::path& path,
                                                   const study::Study& study,
                                                   const std::string& hand_device);

}  // namespace touchtrial::app
