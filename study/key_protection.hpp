/// \file Passphrases of the files of secrets. A protected file holds the text of a key or of a
/// station's file, sealed under a key that Argon2id makes of the passphrase. Everything that loads
/// or saves keys goes through here, so nothing else knows of passphrases. Format:
/// docs/data-dictionary.md, "Protected file". All functions are thread-safe.
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

/// Gives the passphrase of a protected file. It is called again while what it gave was wrong.
/// \param attempt  from 1
/// \return nothing if there is no (further) passphrase to try
using AskPassphrase =
    std::function<std::optional<std::string>(const std::filesystem::path& file, int attempt)>;

/// Who is asked from now on, in the whole program. Unless somebody is, protected files are refused.
/// A file that was opened since is not asked for again.
void ask_passphrases_with(AskPassphrase ask);

/// The fewest bytes of a new passphrase.
inline constexpr std::size_t kShortestPassphrase = 8;

/// Who signs with a protected file: the public half that its clear part names. A file can therefore
/// be told from another's before anybody is asked for a passphrase.
/// \return nothing if no passphrase protects the file
/// \throws FileError if it is missing or cannot be read, or is protected and damaged
[[nodiscard]] std::optional<PublicKey> signer_in_clear(const std::filesystem::path& file);
/// The same of a file's text.
/// \param source  the file's name, for errors
[[nodiscard]] std::optional<PublicKey> signer_in_clear(const std::string& text,
                                                       const std::filesystem::path& source);

/// Whether a passphrase protects the file.
/// \throws FileError if it is missing or cannot be read, or is protected and damaged
[[nodiscard]] bool is_protected(const std::filesystem::path& file);

/// Gives a key or a station's file another passphrase, its first one, or none.
/// \throws UsageError if the new passphrase is too short
/// \throws FileError as load_study_key and load_station_key do
void protect(const std::filesystem::path& file, const std::optional<std::string>& passphrase,
             const PassphraseCost& cost = {});

/// Writes a key under a passphrase, as save_study_key does without.
/// \throws UsageError if the passphrase is too short
/// \throws FileError if the file cannot be written
void save_study_key(const std::filesystem::path& path, const StudyKey& key,
                    const std::string& passphrase, const PassphraseCost& cost = {});

/// \name The texts of files of secrets
///@{

/// The text of a file, opened if it is protected.
/// \throws FileError if the file is missing, can be read by others, is damaged although protected,
///   or its passphrase is wrong or not known
[[nodiscard]] std::string read_secret_text(const std::filesystem::path& path);

/// Writes a text durably with mode 0600. Where it replaces a protected file, the text is protected
/// by the same passphrase.
/// \param signer  who signs with the file
/// \throws FileError as read_secret_text does, or if the file cannot be written
void save_secret_text(const std::filesystem::path& path, const std::string& text,
                      const PublicKey& signer);

/// Writes a text durably with mode 0600, under this passphrase, or in clear without one.
/// \param signer  as for save_secret_text
/// \throws UsageError if the passphrase is too short
/// \throws FileError if the file cannot be written
void write_secret_text(const std::filesystem::path& path, const std::string& text,
                       const PublicKey& signer, const std::optional<std::string>& passphrase,
                       const PassphraseCost& cost);

///@}

}  // namespace touchtrial::study
