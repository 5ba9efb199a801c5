#include "house/house.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <utility>

namespace touchtrial::house {
namespace {

namespace fs = std::filesystem;

std::string text_of_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The room with the longest folder that a path lies in; null for none.
const Room* room_of(const std::string& path) {
  const Room* best = nullptr;
  for (const Room& room : rooms()) {
    if (!path.starts_with(room.folder + "/")) continue;
    if (best == nullptr || room.folder.size() > best->folder.size()) best = &room;
  }
  return best;
}

void sort_includes(SourceFile& file) {
  for (const std::string& written : file.declared.includes) {
    if (written.size() < 3) continue;
    const std::string name = written.substr(1, written.size() - 2);
    const bool is_ours = written.front() == '"' || room_of(name) != nullptr;
    (is_ours ? file.quoted : file.angled).push_back(name);
  }
}

/// The C++ standard library's headers have neither folder nor ending; all others have.
bool is_third_party(const std::string& header) {
  return header.find_first_of("/.") != header.npos;
}

/// The folder that a header says it is private to: the one it names, else its own; "" for none.
std::string private_to(const SourceFile& header) {
  std::string comment;
  std::istringstream lines(header.text);
  for (std::string line; std::getline(lines, line) && line.starts_with("///");) {
    comment += line.substr(3);
  }
  std::smatch found;
  if (!std::regex_search(comment, found, std::regex("[Pp]rivate to\\s+([\\w/]*\\w)"))) return "";
  const std::string own = fs::path(header.path).parent_path().generic_string();
  const std::string named = found[1];
  return (own + "/").starts_with(named + "/") ? named : own;
}

/// Headers that others compile as C: they have no namespace, and the end that C's headers have.
bool is_for_c(const std::string& path) {
  return path == "device/plugin/touchtrial_device.h";
}

std::string kind_of(const Definition& definition) {
  switch (definition.kind) {
    case Definition::Kind::type:
      return "type ";
    case Definition::Kind::function:
      return "function ";
    case Definition::Kind::variable:
      return "variable ";
  }
  return "";
}

/// Whether a protocol's part belongs to this layer: its namespace then lies in the layer's.
bool in_one_layer(const Room& part, const Room* layer) {
  if (layer == nullptr) return false;
  return layer == &part || (layer->name_space != "touchtrial" &&
                            part.name_space.starts_with(layer->name_space + "::"));
}

/// Highway's kernels include themselves, and so are compiled alone.
bool is_compiled_alone(const SourceFile& file) {
  return std::count(file.angled.begin(), file.angled.end(), "hwy/foreach_target.h") > 0;
}

/// Whether other files may define the name too, as long as they are not joined with this one.
bool is_local(const SourceFile& file, const Definition& definition) {
  return definition.is_internal && !file.is_header();
}

/// What only one file may define: a local name is one in its folder, whose files are joined.
std::string name_to_define(const SourceFile& file, const Definition& definition) {
  std::string name = definition.name;
  if (definition.kind == Definition::Kind::function) name += "(" + definition.parameters + ")";
  if (is_local(file, definition)) {
    static const std::string anonymous = "(anonymous)::";
    if (const std::size_t at = name.find(anonymous); at != name.npos) {
      name.erase(at, anonymous.size());
    }
    name += " of folder " + fs::path(file.path).parent_path().generic_string();
  }
  return kind_of(definition) + name;
}

}  // namespace

const std::vector<Room>& rooms() {
  static const std::vector<Room> all = [] {
    const std::set<std::string> session = {"core", "engine", "device", "protocols/store",
                                           "protocols/design"};
    const std::set<std::string> analysis = {"core", "engine", "protocols/store",
                                            "protocols/design"};
    std::set<std::string> simulation = session;
    simulation.insert("protocols/session");
    std::set<std::string> planning = simulation;
    planning.insert({"protocols/simulation", "analysis", "protocols/identification/analysis",
                     "protocols/threshold/design", "protocols/procedures"});
    std::set<std::string> compared = simulation;
    compared.insert({"protocols/simulation", "protocols/threshold/design", "protocols/procedures"});
    std::set<std::string> identified = simulation;
    identified.insert({"protocols/simulation", "protocols/identification/design"});
    std::set<std::string> analysed = analysis;
    analysed.insert({"analysis", "protocols/identification/design"});
    std::set<std::string> measured = analysis;
    measured.insert({"analysis", "protocols/threshold/design", "protocols/procedures"});
    std::set<std::string> registered = planning;
    registered.insert({"protocols/threshold/simulation", "protocols/threshold/analysis"});
    registered.insert({"protocols/identification/design", "protocols/identification/simulation",
                       "protocols/identification/analysis"});
    std::set<std::string> app = registered;
    app.insert("protocols/registration");
    app.insert({"protocols/collect", "analysis/planning", "stimuli"});
    std::set<std::string> bench = app;
    bench.insert("app");
    return std::vector<Room>{
        {"core", "touchtrial", {}},
        {"engine", "touchtrial::engine", {"core"}},
        {"device", "touchtrial::device", {"core"}},
        {"protocols/store", "touchtrial::store", {"core"}},
        {"protocols/collect", "touchtrial::collect", {"core", "protocols/store"}},
        {"protocols/procedures", "touchtrial::procedures", {"core"}},
        {"protocols/design", "touchtrial::design", {"core", "engine"}},
        {"protocols/identification/design",
         "touchtrial::design::identification",
         {"core", "engine", "protocols/design"}},
        {"protocols/threshold/design",
         "touchtrial::design::threshold",
         {"core", "engine", "protocols/design", "protocols/procedures"}},
        {"protocols/session", "touchtrial::session", session},
        {"protocols/simulation", "touchtrial::simulation", simulation},
        {"protocols/identification/simulation", "touchtrial::simulation::identification",
         identified},
        {"protocols/threshold/simulation", "touchtrial::simulation::threshold", compared},
        {"analysis", "touchtrial::analysis", analysis},
        {"protocols/identification/analysis", "touchtrial::analysis::identification", analysed},
        {"protocols/threshold/analysis", "touchtrial::analysis::threshold", measured},
        {"analysis/planning", "touchtrial::planning", planning},
        {"protocols/registration", "touchtrial::registration", registered},
        {"stimuli", "touchtrial::stimuli", {"core", "engine"}},
        {"app", "touchtrial::app", app},
        {"python", "touchtrial::python", bench},
        {"bench", "touchtrial::bench", bench, true},
    };
  }();
  return all;
}

House::House(fs::path root) : root_(std::move(root)) {
  std::set<std::string> tops;
  for (const Room& room : rooms()) tops.insert(room.folder.substr(0, room.folder.find('/')));
  for (const std::string& top : tops) {
    if (!fs::exists(root_ / top)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root_ / top)) {
      read(fs::relative(entry.path(), root_).generic_string());
    }
  }
  std::sort(files_.begin(), files_.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
}

void House::read(const std::string& path) {
  static const std::set<std::string> others = {".h",   ".hh",  ".hxx", ".c",  ".cc",
                                               ".cxx", ".inl", ".ipp", ".tpp"};
  const std::string ending = fs::path(path).extension().string();
  if (is_for_c(path)) return;
  if (others.count(ending) > 0) not_read_.push_back(path + " ends neither in .hpp nor in .cpp");
  if (ending != ".hpp" && ending != ".cpp") return;
  SourceFile file{path, room_of(path), text_of_file(root_ / path), {}, {}, {}};
  if (file.room == nullptr) {
    not_read_.push_back(path + " lies in no room");
    return;
  }
  file.declared = declarations_in(file.text);
  sort_includes(file);
  files_.push_back(std::move(file));
}

const SourceFile* House::find(const std::string& path) const {
  const auto found = std::find_if(files_.begin(), files_.end(),
                                  [&](const SourceFile& file) { return file.path == path; });
  return found == files_.end() ? nullptr : &*found;
}

std::vector<std::string> House::wrong_includes() const {
  std::vector<std::string> found;
  for (const SourceFile& file : files_) {
    for (const std::string& name : file.quoted) {
      const std::string what = file.path + " includes " + name;
      if (file.room->sees_inside && name.starts_with("tests/")) continue;
      const Room* to = room_of(name);
      if (!fs::exists(root_ / name)) {
        found.push_back(what + ", which is not there");
      } else if (to == nullptr) {
        found.push_back(what + ", which is in no room");
      } else if (find(name) == nullptr && !is_for_c(name)) {
        found.push_back(what + ", which is not read: headers end in .hpp");
      } else if (to != file.room && file.room->arrows.count(to->folder) == 0) {
        found.push_back(what + " against the arrows");
      }
    }
  }
  return found;
}

std::vector<std::string> House::third_party_headers_shown() const {
  std::set<std::string> showing;
  for (std::size_t before = files_.size(); before != showing.size();) {
    before = showing.size();
    for (const SourceFile& file : files_) {
      if (!file.is_header()) continue;
      const bool shows = std::any_of(file.angled.begin(), file.angled.end(), is_third_party) ||
                         std::any_of(file.quoted.begin(), file.quoted.end(),
                                     [&](const std::string& n) { return showing.count(n) > 0; });
      if (shows) showing.insert(file.path);
    }
  }
  std::vector<std::string> found;
  for (const SourceFile& file : files_) {
    for (const std::string& name : file.quoted) {
      if (showing.count(name) == 0 || file.room->sees_inside) continue;
      if (in_one_layer(*file.room, room_of(name))) continue;
      found.push_back(file.path + " includes " + name + ", which shows a third-party header");
    }
  }
  return found;
}

std::vector<std::string> House::private_headers_used_elsewhere() const {
  std::vector<std::string> found;
  for (const SourceFile& file : files_) {
    if (file.room->sees_inside) continue;
    for (const std::string& name : file.quoted) {
      const SourceFile* header = find(name);
      const std::string folder = header == nullptr ? "" : private_to(*header);
      if (folder.empty() || file.path.starts_with(folder + "/")) continue;
      found.push_back(file.path + " includes " + name + ", which is private to " + folder);
    }
  }
  return found;
}

std::vector<std::string> House::names_defined_twice() const {
  std::map<std::string, std::map<std::string, std::string>> files_by_meaning;
  for (const SourceFile& file : files_) {
    if (file.once_a_target()) continue;
    for (const Definition& definition : file.declared.definitions) {
      const bool local = is_local(file, definition);
      if (definition.name == "main" || (local && is_compiled_alone(file))) continue;
      // Joined files may repeat an alias.
      const bool may_repeat = local && !definition.aliased.empty();
      files_by_meaning[name_to_define(file, definition)].emplace(
          may_repeat ? definition.aliased : file.path, file.path);
    }
  }
  std::vector<std::string> found;
  for (const auto& [name, files] : files_by_meaning) {
    if (files.size() < 2) continue;
    std::string line = name + " is defined in";
    for (const auto& [meaning, path] : files) line += " " + path;
    found.push_back(line);
  }
  return found;
}

std::vector<std::string> House::namespaces_of_other_rooms() const {
  std::vector<std::string> found;
  for (const SourceFile& file : files_) {
    const std::string& own = file.room->name_space;
    bool opens_own = false;
    for (const auto& [name, holds_more] : file.declared.namespaces) {
      const Room* other = nullptr;
      for (const Room& room : rooms()) {
        if (&room != file.room && (name + "::").starts_with(room.name_space + "::") &&
            room.name_space.size() > own.size()) {
          other = &room;
        }
      }
      const bool inside = (name + "::").starts_with(own + "::") && other == nullptr;
      opens_own = opens_own || inside;
      if (!inside && holds_more && !(name + "::").starts_with("std::"))
        found.push_back(file.path + " opens namespace " + name);
    }
    for (const Definition& definition : file.declared.definitions) {
      const bool is_c = definition.name.starts_with("extern");
      if (definition.name.find("::") == std::string::npos && definition.name != "main" && !is_c)
        found.push_back(file.path + " defines " + definition.name + " in no namespace");
    }
    for (const std::string& used : file.declared.used_namespaces) {
      if (file.is_header()) found.push_back(file.path + " uses all of namespace " + used);
    }
    if (!opens_own && !file.path.ends_with("main.cpp")) {
      found.push_back(file.path + " does not open namespace " + own);
    }
  }
  return found;
}

std::vector<std::string> House::unguarded_or_unexplained_headers() const {
  std::vector<std::string> found;
  for (const SourceFile& file : files_) {
    if (!file.declared.is_complete) {
      found.push_back(file.path + " cannot be read: a bracket has no partner");
    }
    if (!file.is_header()) continue;
    if (!file.text.starts_with("/// \\file ")) {
      found.push_back(file.path + " does not begin by saying what it is for");
    }
    if (!file.once_a_target() && file.text.find("#pragma once") == std::string::npos) {
      found.push_back(file.path + " does not guard itself");
    }
  }
  return found;
}

}  // namespace touchtrial::house
