#include "record/payload_json.hpp"

#include "core/bytes.hpp"
#include "record/event_kinds.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

namespace touchtrial::record {
namespace {

using Json = nlohmann::json;

std::string compact_text(const Json& object) {
  try {
    return object.dump();
  } catch (const Json::exception&) {
    throw StoreError(
        "a text is not UTF-8 and cannot be stored; type it again without special characters");
  }
}

/// Writes the members of a body into one JSON object, without checking limits.
class BodyWriter final : public BodyIo {
 public:
  Json json = Json::object();

 private:
  Json& at(const Member& member) { return json[std::string(member.key)]; }

  bool has(const Member& /*member*/, bool has_value) override { return has_value; }
  void text(const Member& member, std::string& value) override { at(member) = value; }
  void boolean(const Member& member, bool& value) override { at(member) = value; }
  void number(const Member& member, double& value) override {
    // JSON has no infinities.
    if (!std::isfinite(value)) {
      throw StoreError("/" + std::string(member.key) +
                       " is not a finite number and cannot be stored; check the device");
    }
    at(member) = value;
  }
  void integer(const Member& member, std::int64_t& value, std::int64_t /*max*/) override {
    at(member) = value;
  }
  void bytes(const Member& member, std::span<std::uint8_t> value) override {
    at(member) = to_hex(ByteView(value));
  }
  void word(const Member& member, std::size_t& value,
            std::span<const std::string_view> words) override {
    at(member) = words[value];
  }
  void numbers(const Member& member, std::span<double> value) override {
    at(member) = std::vector<double>(value.begin(), value.end());
  }
  void numbers(const Member& member, std::vector<double>& value) override { at(member) = value; }
  void integers(const Member& member, std::vector<std::int64_t>& value,
                std::int64_t /*max*/) override {
    at(member) = value;
  }
  void object(const Member& member, const std::function<void(BodyIo&)>& describe) override {
    BodyWriter inner;
    describe(inner);
    at(member) = std::move(inner.json);
  }
};

/// Reads the members of a body from one JSON object, or from two.
class BodyReader final : public BodyIo {
 public:
  /// \throws StoreError if a text is not one JSON object
  explicit BodyReader(const BodyParts& parts) : first_(parse_object(parts.clear)) {
    if (!parts.hidden.empty()) second_ = parse_object(parts.hidden);
  }

  [[nodiscard]] bool reads() const override { return true; }

 private:
  /// Reads a nested object.
  BodyReader(const BodyReader& outer, std::string_view key, const Json& object)
      : first_(object), pointer_(outer.pointer_ + "/" + std::string(key)) {}

  [[nodiscard]] static Json parse_object(std::string_view text) {
    Json object = Json::parse(text, nullptr, /*allow_exceptions=*/false);
    if (!object.is_object()) throw StoreError("the body is not a JSON object");
    return object;
  }

  [[noreturn]] void refuse(const Member& member, const std::string& reason) const {
    throw StoreError(pointer_ + "/" + std::string(member.key) + " " + reason);
  }
  /// \return null if there is none
  [[nodiscard]] const Json* find(const Member& member) const {
    for (const Json* const object : {&second_, &first_}) {
      if (const auto found = object->find(member.key); found != object->end()) return &*found;
    }
    return nullptr;
  }
  [[nodiscard]] const Json& at(const Member& member) const {
    const Json* const found = find(member);
    if (found == nullptr) refuse(member, "is missing");
    return *found;
  }
  [[nodiscard]] const std::string& text_at(const Member& member) const {
    const Json& found = at(member);
    if (!found.is_string()) refuse(member, "is not a text");
    return found.get_ref<const std::string&>();
  }
  [[nodiscard]] const Json& list_at(const Member& member) const {
    const Json& found = at(member);
    if (!found.is_array()) refuse(member, "is not a list");
    return found;
  }
  [[nodiscard]] double number_in(const Member& member, const Json& item) const {
    if (!item.is_number()) refuse(member, "contains an item that is not a number");
    return item.get<double>();
  }

  bool has(const Member& member, bool /*has_value*/) override { return find(member) != nullptr; }
  void text(const Member& member, std::string& value) override { value = text_at(member); }
  void boolean(const Member& member, bool& value) override {
    const Json& found = at(member);
    if (!found.is_boolean()) refuse(member, "is neither true nor false");
    value = found.get<bool>();
  }
  void number(const Member& member, double& value) override {
    const Json& found = at(member);
    if (!found.is_number()) refuse(member, "is not a number");
    value = found.get<double>();
  }
  void integer(const Member& member, std::int64_t& value, std::int64_t max) override {
    const Json& found = at(member);
    if (!found.is_number_integer()) refuse(member, "is not a whole number");
    value = found.get<std::int64_t>();
    const bool is_too_large = found.is_number_unsigned() && value < 0;
    if (is_too_large || value < member.note.min || value > max) refuse(member, "is out of range");
  }
  void bytes(const Member& member, std::span<std::uint8_t> value) override {
    const Json& found = at(member);
    const std::optional<Bytes> bytes =
        found.is_string() ? from_hex(found.get_ref<const std::string&>()) : std::nullopt;
    if (!bytes || bytes->size() != value.size()) {
      refuse(member, "is not " + std::to_string(2 * value.size()) + " hexadecimal digits");
    }
    std::ranges::copy(*bytes, value.begin());
  }
  void word(const Member& member, std::size_t& value,
            std::span<const std::string_view> words) override {
    const auto found = std::ranges::find(words, text_at(member));
    if (found == words.end()) refuse(member, "is not an allowed word");
    value = static_cast<std::size_t>(found - words.begin());
  }
  void numbers(const Member& member, std::span<double> value) override {
    const Json& found = at(member);
    if (!found.is_array() || found.size() != value.size()) {
      refuse(member, "is not a list of the right length");
    }
    std::ranges::transform(found, value.begin(),
                           [&](const Json& item) { return number_in(member, item); });
  }
  void numbers(const Member& member, std::vector<double>& value) override {
    for (const Json& item : list_at(member)) value.push_back(number_in(member, item));
  }
  void integers(const Member& member, std::vector<std::int64_t>& value, std::int64_t max) override {
    for (const Json& item : list_at(member)) {
      if (!item.is_number_unsigned()) {
        refuse(member, "contains an item that is not a whole number from 0");
      }
      value.push_back(item.get<std::int64_t>());
      if (value.back() < member.note.min || value.back() > max) refuse(member, "is out of range");
    }
  }
  void object(const Member& member, const std::function<void(BodyIo&)>& describe) override {
    const Json& found = at(member);
    if (!found.is_object()) refuse(member, "is not an object");
    BodyReader inner(*this, member.key, found);
    describe(inner);
  }

  Json first_ = Json::object();
  Json second_ = Json::object();  ///< its members override those of the first
  std::string pointer_;           ///< JSON pointer
};

/// The member that all bodies about a session have.
struct SessionNumber {
  int session = 0;

  void describe(BodyIo& io) { io("session", session, "", {.min = 1}); }
};

}  // namespace

std::string write_body(const DescribeMembers& describe) {
  BodyWriter writer;
  describe(writer);
  return compact_text(writer.json);
}

void read_body(const BodyParts& parts, const DescribeMembers& describe) {
  BodyReader reader(parts);
  describe(reader);
}

void require_members(const Event& event) {
  try {
    read_body({event.body, ""}, row_of(event.kind).body);
  } catch (const StoreError& error) {
    throw EventFault(event, error.what());
  }
}

TrialMeasures measures_from_json(const std::string& text) try {
  return from_json<TrialMeasures>(text);
} catch (const StoreError& error) {
  throw StoreError(std::string("sealed measures of a trial: ") + error.what() +
                   "; the database is damaged or has another version, restore it from a backup");
}

int session_from_json(const std::string& text) {
  return from_json<SessionNumber>(text).session;
}

// Works on JSON, so that members added to the structs later do not change collected chains.
std::string renumbered(const std::string& body, int session) {
  static_cast<void>(session_from_json(body));
  Json object = Json::parse(body);
  object["session"] = session;
  return compact_text(object);
}

std::string renumbered_opening(const std::string& body, int session, int station) {
  const int own_session = session_from_json(body);
  Json object = Json::parse(body);
  object["session"] = session;
  object["own_session"] = own_session;
  object["station"] = station;
  return compact_text(object);
}

}  // namespace touchtrial::record
