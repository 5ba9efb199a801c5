#include "record/body_parts.hpp"

#include "core/errors.hpp"
#include "record/event_kinds.hpp"

#include <algorithm>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial::record {
namespace {

bool is_sealed(const ListedMember& listed) {
  return listed.member.note.sealed;
}

nlohmann::json object_of(const std::string& text) {
  nlohmann::json object = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!object.is_object()) throw StoreError("the body is not a JSON object");
  return object;
}

}  // namespace

BodyParts split_body(EventKind kind, const std::string& body) {
  const std::vector<ListedMember>& members = members_of(kind);
  if (std::ranges::none_of(members, is_sealed)) return {body, ""};
  nlohmann::json clear = nlohmann::json::object();
  nlohmann::json hidden = nlohmann::json::object();
  const nlohmann::json object = object_of(body);
  for (const auto& item : object.items()) {
    const bool is_clear = std::ranges::any_of(members, [&](const ListedMember& listed) {
      return listed.member.key == item.key() && !is_sealed(listed);
    });
    (is_clear ? clear : hidden)[item.key()] = item.value();
  }
  return {clear.dump(), hidden.empty() ? "" : hidden.dump()};
}

std::string join_body(const BodyParts& parts) {
  if (parts.hidden.empty()) return parts.clear;
  nlohmann::json object = object_of(parts.clear);
  object.update(object_of(parts.hidden));
  return object.dump();
}

std::size_t sealed_padding(EventKind kind) {
  return row_of(kind).sealed_units * kSealedUnit;
}

}  // namespace touchtrial::record
