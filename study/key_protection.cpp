#include "study/key_protection.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

namespace touchtrial::study {
namespace {

constexpr std::string_view kProtectedFormat = "touchtrial-protected";
constexpr int kProtectedVersion = 1;
/// The size limit of a protected file, which has two digits for each byte of its text. The text has
/// at most 64 MiB.
constexpr std::uintmax_t kMaxSecretFileBytes = std::uintmax_t{129} << 20U;

/// The content of a protected file.
struct Envelope {
  PublicKey signer{};
  Salt salt{};
  PassphraseCost cost;
  Bytes box;
};

/// The source of passphrases, and the keys that it has produced.
struct Passphrases {
  std::mutex mutex;
  AskPassphrase prompt;
  std::map<Salt, SecretKey> keys;  ///< keys that opened a file; each file has its own salt
};

Passphrases& passphrases() {
  static Passphrases all;
  return all;
}

[[noreturn]] void refuse_file(const std::filesystem::path& path, const std::string& what) {
  throw FileError(one_line(path.string() + ": " + what));
}

/// The first three lines, which the encryption of the box authenticates.
std::string head_of(const Envelope& envelope) {
  return std::string(kProtectedFormat) + " " + std::to_string(kProtectedVersion) + "\nsigns " +
         to_hex(ByteView(envelope.signer)) + "\nargon2id " + to_hex(ByteView(envelope.salt)) + " " +
         std::to_string(envelope.cost.passes) + " " + std::to_string(envelope.cost.memory_bytes) +
         "\n";
}

std::string text_of_envelope(const Envelope& envelope) {
  const std::string text = head_of(envelope) + to_hex(ByteView(envelope.box)) + "\n";
  return text + to_hex(sha256(bytes_of(text))) + "\n";
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words(1);
  for (const char letter : text) {
    if (letter == ' ' || letter == '\n') {
      words.emplace_back();
    } else {
      words.back() += letter;
    }
  }
  return words;
}

/// \return nothing if the words do not form an envelope
std::optional<Envelope> envelope_of(const std::vector<std::string>& words) {
  // Format, version, signer in two words, argon2id with three numbers, box, hash, end.
  constexpr std::size_t kWords = 11;
  if (words.size() != kWords) return std::nullopt;
  const auto signer = digest_from_hex(words[3]);
  const auto salt = from_hex(words[5]);
  const auto passes = number_in<std::uint64_t>(words[6]);
  const auto memory = number_in<std::uint64_t>(words[7]);
  auto box = from_hex(words[8]);
  Envelope envelope;
  if (!signer || !salt || salt->size() != envelope.salt.size() || !passes || !memory || !box) {
    return std::nullopt;
  }
  envelope.signer = *signer;
  std::ranges::copy(*salt, envelope.salt.begin());
  envelope.cost = {*passes, *memory};
  envelope.box = *std::move(box);
  return envelope;
}

/// \return nothing if the text is not that of a protected file
/// \throws FileError if it has another version or was altered
std::optional<Envelope> envelope_in(const std::string& text, const std::filesystem::path& path) {
  if (!text.starts_with(kProtectedFormat)) return std::nullopt;
  const std::vector<std::string> words = words_of(text);
  std::optional<Envelope> envelope = envelope_of(words);
  if (envelope && !is_in_range(envelope->cost)) {
    refuse_file(path, "requires " + std::to_string(envelope->cost.passes) + " passes over " +
                          std::to_string(envelope->cost.memory_bytes) +
                          " bytes of Argon2id, outside the range that this program writes; restore "
                          "the file from a backup");
  }
  // The content determines the bytes, so any altered byte is detected.
  if (envelope && text_of_envelope(*envelope) == text) return envelope;
  const bool is_newer = words.size() > 1 && number_in<int>(words[1]).value_or(0) > 1;
  if (is_newer) {
    refuse_file(path, "was protected by a newer version of Touchtrial; open it with that version");
  }
  refuse_file(path, "the protected file has been altered or damaged; restore it from a backup");
}

/// The text of a protected file.
/// \param envelope  its box is ignored
std::string sealed_text(Envelope envelope, const SecretKey& key, const std::string& text) {
  envelope.box = seal(key, head_of(envelope), bytes_of(text));
  return text_of_envelope(envelope);
}

/// An envelope's key and the text in it.
struct OpenedEnvelope {
  SecretKey key{};
  std::string text;
};

std::optional<OpenedEnvelope> open_box_of(const SecretKey& key, const Envelope& envelope) {
  const auto text = unseal(key, head_of(envelope), envelope.box);
  if (!text) return std::nullopt;
  return OpenedEnvelope{key, text_of(*text)};
}

OpenedEnvelope open_envelope(const Envelope& envelope, const std::filesystem::path& path) {
  Passphrases& state = passphrases();
  const std::lock_guard lock(state.mutex);
  if (const auto key = state.keys.find(envelope.salt); key != state.keys.end()) {
    if (auto opened = open_box_of(key->second, envelope)) return *std::move(opened);
  }
  for (int attempt = 1;; ++attempt) {
    const auto passphrase = state.prompt ? state.prompt(path, attempt) : std::nullopt;
    if (!passphrase && attempt == 1) {
      refuse_file(path,
                  "is protected by a passphrase; give a file that contains it with "
                  "--passphrase-file, or run this command at a terminal, which asks for it");
    }
    if (!passphrase) refuse_file(path, "the passphrase is wrong; try again with the right one");
    const SecretKey key = key_of_passphrase(*passphrase, envelope.salt, envelope.cost);
    if (auto opened = open_box_of(key, envelope)) {
      state.keys.insert_or_assign(envelope.salt, key);
      return *std::move(opened);
    }
  }
}

std::string text_of_file(const std::filesystem::path& path) {
  return text_of(read_file(path, kMaxSecretFileBytes));
}

bool is_owner_only(const std::filesystem::path& path) {
  constexpr auto kOthers = std::filesystem::perms::group_all | std::filesystem::perms::others_all;
  return (std::filesystem::status(path).permissions() & kOthers) == std::filesystem::perms::none;
}

Salt fresh_salt() {
  SystemEntropy entropy;
  const SecretKey bytes = entropy.secret("salt");
  Salt salt{};
  std::copy_n(bytes.begin(), salt.size(), salt.begin());
  return salt;
}

}  // namespace

void set_passphrase_prompt(AskPassphrase prompt) {
  Passphrases& state = passphrases();
  const std::lock_guard lock(state.mutex);
  state.prompt = std::move(prompt);
  state.keys.clear();
}

std::optional<PublicKey> unencrypted_signer(const std::string& text,
                                            const std::filesystem::path& source) {
  const std::optional<Envelope> envelope = envelope_in(text, source);
  return envelope ? std::optional(envelope->signer) : std::nullopt;
}

std::optional<PublicKey> unencrypted_signer(const std::filesystem::path& file) {
  return unencrypted_signer(text_of_file(file), file);
}

bool is_protected(const std::filesystem::path& file) {
  return unencrypted_signer(file).has_value();
}

std::string read_secret_text(const std::filesystem::path& path) {
  require_owner_only(path);
  std::string text = text_of_file(path);
  const std::optional<Envelope> envelope = envelope_in(text, path);
  return envelope ? open_envelope(*envelope, path).text : text;
}

void save_secret_text(const std::filesystem::path& path, const std::string& text,
                      const PublicKey& signer) {
  const std::string old_text = path_exists(path) ? text_of_file(path) : "";
  if (old_text == text && is_owner_only(path)) return;
  const std::optional<Envelope> envelope = envelope_in(old_text, path);
  if (!envelope) {
    replace_file(path, text, FileMode::owner_only);
    return;
  }
  const SecretKey key = open_envelope(*envelope, path).key;
  const Envelope updated{
      .signer = signer, .salt = envelope->salt, .cost = envelope->cost, .box = {}};
  replace_file(path, sealed_text(updated, key, text), FileMode::owner_only);
}

void write_secret_text(const std::filesystem::path& path, const std::string& text,
                       const PublicKey& signer, const std::optional<std::string>& passphrase,
                       const PassphraseCost& cost) {
  if (!passphrase) {
    replace_file(path, text, FileMode::owner_only);
    return;
  }
  if (passphrase->size() < kMinPassphraseBytes) {
    throw UsageError("the new passphrase of " + one_line(path.string()) + " is too short; use " +
                     std::to_string(kMinPassphraseBytes) +
                     " characters or more, preferably four words");
  }
  const Salt salt = fresh_salt();
  const SecretKey key = key_of_passphrase(*passphrase, salt, cost);
  const Envelope envelope{.signer = signer, .salt = salt, .cost = cost, .box = {}};
  replace_file(path, sealed_text(envelope, key, text), FileMode::owner_only);
  Passphrases& state = passphrases();
  const std::lock_guard lock(state.mutex);
  state.keys.insert_or_assign(salt, key);
}

}  // namespace touchtrial::study
