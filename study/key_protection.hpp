/// \file Passphrase protection of secret files. A protected file contains the text of a key or
/// station file, encrypted with a key that Argon2id derives from the passphrase. Only these
/// functions handle passphrases. Format: docs/data-dictionary.md, "Protected file". All functions
/// are thread-safe.
#pragma once

#include "core/passphrase.hpp"
#include "core/public_keys.hpp"
#include "study/study_key.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace touchtrial::study {

/// Returns the passphrase of a protected file. It is called again after each wrong passphrase.
/// \param attempt  from 1
/// \return nothing if there is no (further) passphrase to try
using AskPassphrase =
    std::function<std::optional<std::string>(const std::filesystem::path& file, int attempt)>;

/// Sets the program's source of passphrases. Without one, protected files are refused. Each file's
/// passphrase is requested once.
void set_passphrase_prompt(AskPassphrase prompt);

/// The minimum length of a new passphrase, bytes.
inline constexpr std::size_t kMinPassphraseBytes = 8;

/// The public signing key named in the unencrypted part of a protected file. It identifies the
/// file's owner before a passphrase is requested.
/// \return nothing if no passphrase protects the file
/// \throws FileError if it is missing or cannot be read, or is protected and damaged
[[nodiscard]] std::optional<PublicKey> unencrypted_signer(const std::filesystem::path& file);
/// The same for a file's text.
/// \param source  the file's name, for errors
[[nodiscard]] std::optional<PublicKey> unencrypted_signer(const std::string& text,
                                                          const std::filesystem::path& source);

/// Whether a passphrase protects the file.
/// \throws FileError if it is missing or cannot be read, or is protected and damaged
[[nodiscard]] bool is_protected(const std::filesystem::path& file);

/// Sets, changes or removes the passphrase of a key or station file.
/// \throws UsageError if the new passphrase is too short
/// \throws FileError as load_study_key and load_station_key do
void protect(const std::filesystem::path& file, const std::optional<std::string>& passphrase,
             const PassphraseCost& cost = {});

/// Like save_study_key, but protects the file with a passphrase.
/// \throws UsageError if the passphrase is too short
/// \throws FileError if the file cannot be written
void save_study_key(const std::filesystem::path& path, const StudyKey& key,
                    const std::string& passphrase, const PassphraseCost& cost = {});

/// \name Texts of secret files
///@{

/// The text of a file, decrypted if it is protected.
/// \throws FileError if the file is missing or readable by others, if it is protected and damaged,
///   or if its passphrase is wrong or unknown
[[nodiscard]] std::string read_secret_text(const std::filesystem::path& path);

/// Writes a text durably with mode 0600. If it replaces a protected file, the same passphrase
/// protects the text.
/// \param signer  the public signing key of the file
/// \throws FileError as read_secret_text does, or if the file cannot be written
void save_secret_text(const std::filesystem::path& path, const std::string& text,
                      const PublicKey& signer);

/// Writes a text durably with mode 0600, encrypted with this passphrase or unencrypted without one.
/// \param signer  as for save_secret_text
/// \throws UsageError if the passphrase is too short
/// \throws FileError if the file cannot be written
void write_secret_text(const std::filesystem::path& path, const std::string& text,
                       const PublicKey& signer, const std::optional<std::string>& passphrase,
                       const PassphraseCost& cost);

///@}

}  // namespace touchtrial::study
