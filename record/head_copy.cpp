#include "record/head_copy.hpp"

#include "core/errors.hpp"
#include "core/strict_json.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

namespace touchtrial::record {
namespace {

constexpr std::size_t kSignatureDigits = 128;
constexpr std::int64_t kHeadVersion = 1;
constexpr std::int64_t kMaxEvents = std::numeric_limits<std::int64_t>::max() - 1;

/// The text that is signed. Its prefix prevents other signed texts from passing for a head.
std::string head_statement(std::string_view text) {
  return "touchtrial head file 1\n" + std::string(text);
}

nlohmann::json json_of(const ChainHead& end) {
  return {{"hash", to_hex(end.hash)}, {"length", end.length}};
}

std::string json_text_of(const HeadRecord& record, const std::filesystem::path& path) {
  nlohmann::json sessions = nlohmann::json::array();
  for (const auto& [session, end] : record.sessions) {
    sessions.push_back(json_of(end));
    sessions.back()["session"] = session;
  }
  const nlohmann::json object = {{"acknowledged", record.acknowledged},
                                 {"also", record.also},
                                 {"count", record.count},
                                 {"database", to_hex(record.database)},
                                 {"file", json_of(record.file)},
                                 {"format", "touchtrial-head"},
                                 {"sessions", std::move(sessions)},
                                 {"station", record.station},
                                 {"study_id", record.study_id},
                                 {"version", kHeadVersion}};
  try {
    return object.dump();
  } catch (const nlohmann::json::exception&) {
    refuse_head(path, "cannot name a folder or station that is not UTF-8; choose another name");
  }
}

Digest digest_at(const JsonObject& object, std::string_view key) {
  const JsonValue value = object.at(key);
  const std::optional<Digest> digest = digest_from_hex(value.text());
  if (!digest) value.refuse("must be 64 hexadecimal digits");
  return *digest;
}

ChainHead end_from(const JsonObject& object) {
  return {.length = object.at("length").integer(0, kMaxEvents), .hash = digest_at(object, "hash")};
}

}  // namespace

void refuse_head(const std::filesystem::path& path, const std::string& reason) {
  throw FileError(one_line(path.string() + ": " + reason));
}

HeadRecord head_record_from(std::string_view text, const std::string& source) {
  const JsonValue document = parse_strict_json(text, source);
  const JsonObject object =
      document.object({"acknowledged", "also", "count", "database", "file", "format", "sessions",
                       "station", "study_id", "version"});
  constexpr std::array<std::string_view, 1> kFormats = {"touchtrial-head"};
  static_cast<void>(object.at("format").choice(kFormats));
  static_cast<void>(object.at("version").integer(kHeadVersion, kHeadVersion));
  HeadRecord record{.study_id = object.at("study_id").text(),
                    .station = object.at("station").text(),
                    .database = digest_at(object, "database"),
                    .count = object.at("count").integer(1, kMaxEvents),
                    .file = end_from(object.at("file").object({"hash", "length"})),
                    .sessions = {},
                    .acknowledged = object.at("acknowledged").integer(0, kMaxEvents),
                    .also = object.at("also").text()};
  for (const JsonValue& item : object.at("sessions").items(0, kMaxHeadSessions)) {
    const JsonObject session = item.object({"hash", "length", "session"});
    const auto number = session.at("session").integer(1, std::numeric_limits<int>::max());
    record.sessions[static_cast<int>(number)] = end_from(session);
  }
  return record;
}

std::string head_copy_of(const HeadRecord& record, const Signer& signer,
                         const std::filesystem::path& path) {
  std::string slot = json_text_of(record, path);
  const Signature signature = signer.sign(bytes_of(head_statement(slot)));
  slot += "\n" + to_hex(signature) + "\n";
  if (slot.size() >= kHeadCopyBytes) {
    refuse_head(path, "can hold " + std::to_string(kHeadCopyBytes - 1) + " bytes, but needs " +
                          std::to_string(slot.size()) +
                          "; choose a second folder with a shorter path");
  }
  slot.append(kHeadCopyBytes - 1 - slot.size(), ' ');
  return slot + '\n';
}

namespace {

/// \return the record's text and its signature; nothing if any byte differs from the format of
///   head_copy_of
std::optional<std::pair<std::string_view, Bytes>> parts_of_copy(std::string_view slot) {
  const std::size_t end = slot.find('\n');
  if (slot.size() != kHeadCopyBytes || end > kHeadCopyBytes - kSignatureDigits - 2)
    return std::nullopt;
  const std::string_view digits = slot.substr(end + 1, kSignatureDigits);
  std::string_view padding = slot.substr(end + 1 + kSignatureDigits);
  if (padding.front() != '\n' || padding.back() != '\n') return std::nullopt;
  padding = padding.substr(1, std::max(padding.size(), std::size_t{2}) - 2);
  if (padding.find_first_not_of(' ') != std::string_view::npos) return std::nullopt;
  std::optional<Bytes> signature = from_hex(digits);
  if (!signature || to_hex(*signature) != digits) return std::nullopt;
  return std::pair(slot.substr(0, end), std::move(*signature));
}

/// The owner that an unsigned record names; empty if it is not a record.
std::string claim_of(std::string_view text) {
  try {
    const HeadRecord record = head_record_from(text, "its text");
    return "station " + record.station + " of study " + record.study_id;
  } catch (const StudyError&) {
    return "";
  }
}

}  // namespace

HeadCopy read_head_copy(std::string bytes, std::span<const PublicKey> signers) {
  HeadCopy copy{.bytes = std::move(bytes), .record = {}, .fault = "is incomplete", .claim = {}};
  const auto parts = parts_of_copy(copy.bytes);
  if (!parts) return copy;
  const std::string_view text = parts->first;
  const Bytes& signature = parts->second;
  const std::string statement = head_statement(text);
  copy.fault = "is altered, or not signed with a key of this study";
  if (std::ranges::none_of(signers, [&](const PublicKey& signer) {
        return is_signed_by(signer, bytes_of(statement), signature);
      })) {
    copy.claim = claim_of(text);
    return copy;
  }
  try {
    copy.record = head_record_from(text, "its text");
    copy.fault.clear();
  } catch (const StudyError& error) {
    copy.fault = std::string("is not a record of this version (") + error.what() + ")";
  }
  return copy;
}

}  // namespace touchtrial::record
