/// \file Reads and writes settings that a `describe` function lists.
#include "core/describe.hpp"

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using nlohmann::ordered_json;

/// Collects the keys of an object.
class KeyCollector final : public ObjectIo {
 public:
  void member(std::string_view key, const KeyInfo& info, bool /*has_value*/,
              const Describe& /*describe*/) override {
    keys_.push_back(key);
    aliases_.insert(aliases_.end(), info.aliases.begin(), info.aliases.end());
  }
  void rule(const Rule& /*rule*/) override {}
  void only_for(std::string_view /*key*/, std::span<const std::string_view> /*words*/,
                std::span<const std::string_view> /*keys*/,
                const std::string& /*message*/) override {}

  [[nodiscard]] const std::vector<std::string_view>& keys() const noexcept { return keys_; }
  [[nodiscard]] std::vector<std::string_view> keys_and_aliases() const {
    std::vector<std::string_view> names = keys_;
    names.insert(names.end(), aliases_.begin(), aliases_.end());
    return names;
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
  void one_of(std::size_t /*form_index*/, std::span<const Form> forms) override {
    const auto fits = [this](const Form& form) { return form.fits(place_); };
    const auto match = std::find_if(forms.begin(), forms.end() - 1, fits);
    match->describe(*this);
  }
  void object(const std::function<void(ObjectIo&)>& describe) override {
    read_settings(place_, describe);
  }
  void rule(const std::function<void(const JsonValue&)>& rule) override { rule(place_); }
  void custom(std::string_view /*schema*/, const std::function<void(const JsonValue&)>& read,
              const std::function<std::string()>& /*text*/) override {
    read(place_);
  }

 private:
  void integer_value(std::int64_t& value, std::int64_t low, std::int64_t high) override {
    value = place_.integer(low, high);
  }
  void choice_index(std::size_t& index, std::span<const std::string_view> words) override {
    index = place_.choice(words);
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

  void member(std::string_view key, const KeyInfo& info, bool /*has_value*/,
              const Describe& describe) override {
    std::optional<JsonValue> match = object_.find(key);
    for (const std::string_view alias : info.aliases) {
      if (!match) match = object_.find(alias);
    }
    if (!match && info.required) match = object_.at(key);
    if (!match) return;
    ValueReader value(*match);
    describe(value);
  }
  void rule(const Rule& rule) override { rule(place_, object_); }
  void only_for(std::string_view key, std::span<const std::string_view> words,
                std::span<const std::string_view> keys, const std::string& message) override {
    const std::optional<JsonValue> value = object_.find(key);
    if (!value || !value->is_text()) return;
    if (std::ranges::find(words, value->text()) != words.end()) return;
    for (const std::string_view restricted : keys) {
      if (const auto match = object_.find(restricted)) match->refuse(message);
    }
  }

 private:
  const JsonValue& place_;
  JsonObject object_;
};

/// JSON pointers of keys that are always written, or only when they differ from their defaults.
struct WriteRules {
  std::set<std::string> required;
  std::set<std::string> if_changed;
};

class ValueWriter final : public ValueIo {
 public:
  ValueWriter(ordered_json& out, std::string pointer, WriteRules& rules)
      : out_(out), pointer_(std::move(pointer)), rules_(rules) {}

  void number(double& value, const NumberRange& /*range*/) override { out_ = value; }
  void boolean(bool& value) override { out_ = value; }
  void text(std::string& value, const TextRule& /*rule*/) override { out_ = value; }
  void one_of(std::size_t form_index, std::span<const Form> forms) override {
    forms[form_index].describe(*this);
  }
  void object(const std::function<void(ObjectIo&)>& describe) override;
  void rule(const std::function<void(const JsonValue&)>& /*rule*/) override {}
  void custom(std::string_view /*schema*/, const std::function<void(const JsonValue&)>& /*read*/,
              const std::function<std::string()>& text) override {
    out_ = ordered_json::parse(text());
  }

 private:
  void integer_value(std::int64_t& value, std::int64_t /*low*/, std::int64_t /*high*/) override {
    out_ = value;
  }
  void choice_index(std::size_t& index, std::span<const std::string_view> words) override {
    out_ = index < words.size() ? words[index] : "unknown";
  }
  void entries(const ListRange& /*range*/, const Entries& entries) override {
    out_ = ordered_json::array();
    for (std::size_t i = 0; i < entries.size(); ++i) {
      ValueWriter item(out_.emplace_back(), pointer_ + "/" + std::to_string(i), rules_);
      entries.describe(item, i);
    }
  }

  ordered_json& out_;
  std::string pointer_;
  WriteRules& rules_;
};

class ObjectWriter final : public ObjectIo {
 public:
  ObjectWriter(ordered_json& out, std::string pointer, WriteRules& rules)
      : out_(out), pointer_(std::move(pointer)), rules_(rules) {
    out_ = ordered_json::object();
  }

  void member(std::string_view key, const KeyInfo& info, bool has_value,
              const Describe& describe) override {
    if (!has_value || !info.written) return;
    const std::string pointer = pointer_ + "/" + std::string(key);
    if (info.required) rules_.required.insert(pointer);
    if (info.if_changed) rules_.if_changed.insert(pointer);
    ValueWriter value(out_[std::string(key)], pointer, rules_);
    describe(value);
  }
  void rule(const Rule& /*rule*/) override {}
  void only_for(std::string_view /*key*/, std::span<const std::string_view> /*words*/,
                std::span<const std::string_view> /*keys*/,
                const std::string& /*message*/) override {}

 private:
  ordered_json& out_;
  std::string pointer_;
  WriteRules& rules_;
};

void ValueWriter::object(const std::function<void(ObjectIo&)>& describe) {
  ObjectWriter object(out_, pointer_, rules_);
  describe(object);
}

/// Removes keys that have their default values.
/// \param is_optional  whether the key with this pointer may be left out
void leave_out_defaults(ordered_json& object, const ordered_json& defaults,
                        const std::string& pointer,
                        const std::function<bool(const std::string&)>& is_optional) {
  for (auto it = object.begin(); it != object.end();) {
    const auto default_value = defaults.find(it.key());
    const std::string member_pointer = pointer + "/" + it.key();
    if (default_value != defaults.end() && *default_value == *it && is_optional(member_pointer)) {
      it = object.erase(it);
      continue;
    }
    if (default_value != defaults.end() && default_value->is_object() && it->is_object()) {
      leave_out_defaults(*it, *default_value, member_pointer, is_optional);
    }
    ++it;
  }
}

std::string text_of(const ordered_json& document) {
  return document.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace

void ValueIo::axes(Vec3& value, const NumberRange& range) {
  std::vector<double> components = {value.x, value.y, value.z};
  list(components, {.min = 3, .max = 3},
       [&range](ValueIo& io, double& number) { io.number(number, range); });
  value = {components[0], components[1], components[2]};
}

std::vector<std::string_view> keys_of(const Description& description) {
  KeyCollector collector;
  description(collector);
  return collector.keys();
}

void read_settings(const JsonValue& place, const Description& description) {
  KeyCollector collector;
  description(collector);
  ObjectReader reader(place, collector.keys_and_aliases());
  description(reader);
}

std::string described_json(const Description& description, const Description& defaults,
                           WrittenKeys keys) {
  WriteRules rules;
  ordered_json document;
  ordered_json default_values;
  ObjectWriter writer(document, "", rules);
  description(writer);
  ObjectWriter default_writer(default_values, "", rules);
  defaults(default_writer);
  leave_out_defaults(document, default_values, "", [&](const std::string& pointer) {
    if (rules.required.contains(pointer)) return false;
    return keys == WrittenKeys::changed || rules.if_changed.contains(pointer);
  });
  return text_of(document);
}

std::string described_json(const std::function<void(ValueIo&)>& describe) {
  WriteRules unused;
  ordered_json document;
  ValueWriter writer(document, "", unused);
  describe(writer);
  return text_of(document);
}

}  // namespace touchtrial
