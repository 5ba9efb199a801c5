#include "analysis/verification.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/design/study_key.hpp"
#include "protocols/store/study_store.hpp"

#include <filesystem>
#include <memory>
#include <optional>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;

constexpr int kNotVerified = 3;

struct VerifyArguments {
  fs::path database;
  fs::path key;
  fs::path pack;
  bool json = false;
};

/// A key that was named must be there; the one beside the database may be elsewhere.
std::optional<StudyKey> key_for(const VerifyArguments& arguments) {
  const fs::path path = key_path_for(arguments.database, arguments.key);
  if (arguments.key.empty() && !fs::exists(path)) return std::nullopt;
  return load_study_key(path);
}

std::optional<Pack> pack_for(const VerifyArguments& arguments, const std::optional<StudyKey>& key) {
  if (!arguments.pack.empty()) return Pack(arguments.pack);
  if (key && fs::exists(key->pack_folder)) return Pack(key->pack_folder);
  return std::nullopt;
}

int verify(const VerifyArguments& arguments) {
  const StudyStore store = StudyStore::open(arguments.database, StudyStore::Access::read_only);
  const std::optional<StudyKey> key = key_for(arguments);
  const std::optional<Pack> pack = pack_for(arguments, key);
  const Verification verification =
      verify_study(store, key ? &*key : nullptr, pack ? &*pack : nullptr);
  print(arguments.json ? verification_json(verification) : verification_text(verification));
  return verification.holds() ? 0 : kNotVerified;
}

}  // namespace

void add_verify_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<VerifyArguments>();
  CLI::App* command = program.add_subcommand(
      "verify", "Hold chain, seal, schedule, payloads and pack against each other");
  command->add_option("DB", arguments->database, "Database of the study")->required();
  command->add_option("--key", arguments->key, "Key of the study (default: DB.key, if there)");
  command->add_option("--pack", arguments->pack, "Pack of the study (default: where the key says)");
  command->add_flag("--json", arguments->json, "One JSON object in place of lines");
  command->callback([=, &action] { action = [=] { return verify(*arguments); }; });
}

}  // namespace touchtrial
