/// \file Reading and writing settings by their description.
#include "core/describe.hpp"

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using nlohmann::ordered_json;

/// Learns the keys of an object.
class KeyCollector final : public ObjectIo {
 public:
  void member(std::string_view key, const KeyInfo& info, bool /*is_there*/,
              const Describe& /*describe*/) override {
    keys_.push_back(key);
    aliases_.insert(aliases_.end(), info.aliases.begin(), info.aliases.end());
  }
  void rule(const Rule& /*rule*/) override {}
  void only_for(std::string_view /*key*/, std::span<const std::string_view> /*words*/,
                std::span<const std::string_view> /*keys*/,
                const std::string& /*otherwise*/) override {}

  [[nodiscard]] const std::vector<std::string_view>& keys() const noexcept { return keys_; }
  /// With other names of them.
  [[nodiscard]] std::vector<std::string_view> known() const {
    std::vector<std::string_view> known = keys_;
    known.insert(known.end(), aliases_.begin(), aliases_.end());
    return known;
  }

 private:
  std::vector<std::string_view> keys_;
  std::vector<std::string_view> aliases_;
};

class ValueReader final : public ValueIo {
 public:
  explicit ValueReader(const JsonValue& place) : place_(place) {}

  void number(double& value, const NumberRange& range) override { value = place_.number(range); }
  void boolean(bool& value) override { value = place_.boolean(); }
  void text(std::string& value, const TextRule& rule) override {
    value = place_.text();
    if (rule.check != nullptr) rule.check(place_);
  }
  void one_of(std::size_t /*written*/, std::span<const Form> forms) override {
    const auto fits = [this](const Form& form) { return form.fits(place_); };
    const auto found = std::find_if(forms.begin(), forms.end() - 1, fits);
    found->describe(*this);
  }
  void object(const std::function<void(ObjectIo&)>& describe) override {
    read_described(place_, describe);
  }
  void rule(const std::function<void(const JsonValue&)>& rule) override { rule(place_); }
  void custom(std::string_view /*schema*/, const std::function<void(const JsonValue&)>& read,
              const std::function<std::string()>& /*text*/) override {
    read(place_);
  }

 private:
  void whole_number(std::int64_t& value, std::int64_t low, std::int64_t high) override {
    value = place_.integer(low, high);
  }
  void word(std::size_t& at, std::span<const std::string_view> words) override {
    at = place_.choice(words);
  }
  void entries(const ListRange& range, const Entries& entries) override {
    const std::vector<JsonValue> items = place_.items(range.min, range.max);
    entries.resize(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
      ValueReader item(items[i]);
      entries.describe(item, i);
    }
  }

  const JsonValue& place_;
};

class ObjectReader final : public ObjectIo {
 public:
  ObjectReader(const JsonValue& place, std::span<const std::string_view> keys)
      : place_(place), object_(place.object(keys)) {}

  void member(std::string_view key, const KeyInfo& info, bool /*is_there*/,
              const Describe& describe) override {
    std::optional<JsonValue> found = object_.find(key);
    for (const std::string_view other : info.aliases) {
      if (!found) found = object_.find(other);
    }
    if (!found && info.required) found = object_.at(key);
    if (!found) return;
    ValueReader value(*found);
    describe(value);
  }
  void rule(const Rule& rule) override { rule(place_, object_); }
  void only_for(std::string_view key, std::span<const std::string_view> words,
                std::span<const std::string_view> keys, const std::string& otherwise) override {
    const std::optional<JsonValue> word = object_.find(key);
    if (!word || !word->is_text()) return;
    if (std::ranges::find(words, word->text()) != words.end()) return;
    for (const std::string_view other : keys) {
      if (const auto found = object_.find(other)) {
        found->refuse(otherwise);
      }
    }
  }

 private:
  const JsonValue& place_;
  JsonObject object_;
};

/// Keys that are always written, and those that are if they differ from their defaults, as JSON
/// pointers.
struct Marks {
  std::set<std::string> required;
  std::set<std::string> if_changed;
};

class ValueWriter final : public ValueIo {
 public:
  ValueWriter(ordered_json& out, std::string pointer, Marks& marks)
      : out_(out), pointer_(std::move(pointer)), marks_(marks) {}

  void number(double& value, const NumberRange& /*range*/) override { out_ = value; }
  void boolean(bool& value) override { out_ = value; }
  void text(std::string& value, const TextRule& /*rule*/) override { out_ = value; }
  void one_of(std::size_t written, std::span<const Form> forms) override {
    forms[written].describe(*this);
  }
  void object(const std::function<void(ObjectIo&)>& describe) override;
  void rule(const std::function<void(const JsonValue&)>& /*rule*/) override {}
  void custom(std::string_view /*schema*/, const std::function<void(const JsonValue&)>& /*read*/,
              const std::function<std::string()>& text) override {
    out_ = ordered_json::parse(text());
  }

 private:
  void whole_number(std::int64_t& value, std::int64_t /*low*/, std::int64_t /*high*/) override {
    out_ = value;
  }
  void word(std::size_t& at, std::span<const std::string_view> words) override {
    out_ = at < words.size() ? words[at] : "unknown";
  }
  void entries(const ListRange& /*range*/, const Entries& entries) override {
    out_ = ordered_json::array();
    for (std::size_t i = 0; i < entries.size(); ++i) {
      ValueWriter item(out_.emplace_back(), pointer_ + "/" + std::to_string(i), marks_);
      entries.describe(item, i);
    }
  }

  ordered_json& out_;
  std::string pointer_;
  Marks& marks_;
};

class ObjectWriter final : public ObjectIo {
 public:
  ObjectWriter(ordered_json& out, std::string pointer, Marks& marks)
      : out_(out), pointer_(std::move(pointer)), marks_(marks) {
    out_ = ordered_json::object();
  }

  void member(std::string_view key, const KeyInfo& info, bool is_there,
              const Describe& describe) override {
    if (!is_there || !info.written) return;
    const std::string pointer = pointer_ + "/" + std::string(key);
    if (info.required) marks_.required.insert(pointer);
    if (info.if_changed) marks_.if_changed.insert(pointer);
    ValueWriter value(out_[std::string(key)], pointer, marks_);
    describe(value);
  }
  void rule(const Rule& /*rule*/) override {}
  void only_for(std::string_view /*key*/, std::span<const std::string_view> /*words*/,
                std::span<const std::string_view> /*keys*/,
                const std::string& /*otherwise*/) override {}

 private:
  ordered_json& out_;
  std::string pointer_;
  Marks& marks_;
};

void ValueWriter::object(const std::function<void(ObjectIo&)>& describe) {
  ObjectWriter object(out_, pointer_, marks_);
  describe(object);
}

/// Removes keys that have their default values.
/// \param may_leave  whether a key of this pointer may be left out
void leave_out_defaults(ordered_json& object, const ordered_json& defaults,
                        const std::string& pointer,
                        const std::function<bool(const std::string&)>& may_leave) {
  for (auto it = object.begin(); it != object.end();) {
    const auto before = defaults.find(it.key());
    const std::string place = pointer + "/" + it.key();
    if (before != defaults.end() && *before == *it && may_leave(place)) {
      it = object.erase(it);
      continue;
    }
    if (before != defaults.end() && before->is_object() && it->is_object()) {
      leave_out_defaults(*it, *before, place, may_leave);
    }
    ++it;
  }
}

std::string text_of(const ordered_json& written) {
  return written.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace

void ValueIo::axes(Vec3& value, const NumberRange& range) {
  std::vector<double> all = {value.x, value.y, value.z};
  list(all, {.min = 3, .max = 3},
       [&range](ValueIo& io, double& number) { io.number(number, range); });
  value = {all[0], all[1], all[2]};
}

std::vector<std::string_view> keys_of(const Description& description) {
  KeyCollector collector;
  description(collector);
  return collector.keys();
}

void read_described(const JsonValue& place, const Description& description) {
  KeyCollector collector;
  description(collector);
  ObjectReader reader(place, collector.known());
  description(reader);
}

std::string written_as_described(const Description& description, const Description& defaults,
                                 WrittenKeys keys) {
  Marks marks;
  ordered_json written;
  ordered_json default_values;
  ObjectWriter writer(written, "", marks);
  description(writer);
  ObjectWriter of_defaults(default_values, "", marks);
  defaults(of_defaults);
  leave_out_defaults(written, default_values, "", [&](const std::string& pointer) {
    if (marks.required.contains(pointer)) return false;
    return keys == WrittenKeys::changed || marks.if_changed.contains(pointer);
  });
  return text_of(written);
}

std::string written_as_described(const std::function<void(ValueIo&)>& describe) {
  Marks none;
  ordered_json written;
  ValueWriter writer(written, "", none);
  describe(writer);
  return text_of(written);
}

}  // namespace touchtrial
