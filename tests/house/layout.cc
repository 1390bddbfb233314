#include "tests/house/layout.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>

namespace likeness::house {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string place(const std::string& path, std::size_t line_index) {
  return path + ":" + std::to_string(line_index + 1) + ": ";
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash);
}

std::string extension_of(const std::string& path) {
  const std::size_t dot = path.rfind('.'), slash = path.rfind('/');
  return dot == std::string::npos || (slash != std::string::npos && dot < slash) ? "" : path.substr(dot + 1);
}

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool is_cpp(const std::string& path) { return is_one_of(extension_of(path), {"h", "hpp", "cc", "cpp"}); }
bool is_source(const std::string& path) {
  return is_cpp(path) || is_one_of(extension_of(path), {"js", "css", "html", "py", "sh", "cmake", "glsl"});
}

// The room whose folder holds the path, the innermost if several do; empty if none.
std::string room_of(const std::map<std::string, Room>& rooms, const std::string& path) {
  std::string found;
  std::size_t longest = 0;
  for (const auto& [name, room] : rooms) {
    if (path.starts_with(room.folder + "/") && room.folder.size() > longest) {
      longest = room.folder.size();
      found = name;
    }
  }
  return found;
}

// Everything that a room stands on, itself included.
std::set<std::string> foundations(const std::map<std::string, Room>& rooms, const std::string& name) {
  std::set<std::string> all;
  std::vector<std::string> open{name};
  while (!open.empty()) {
    const std::string next = open.back();
    open.pop_back();
    if (!all.insert(next).second) continue;
    if (const auto at = rooms.find(next); at != rooms.end())
      open.insert(open.end(), at->second.needs.begin(), at->second.needs.end());
  }
  return all;
}

}  // namespace

std::map<std::string, Room> rooms_of(const Tree& tree) {
  std::map<std::string, Room> rooms;
  for (const auto& [path, content] : tree) {
    if (path.substr(path.rfind('/') + 1) != "CMakeLists.txt") continue;
    const std::string code = std::regex_replace(content, std::regex("#[^\n]*"), "");
    const std::regex call(R"(likeness_library\s*\(([^)]*)\))");
    for (std::sregex_iterator at(code.begin(), code.end(), call), end; at != end; ++at) {
      std::istringstream words((*at)[1].str());
      std::string name, word, list;
      words >> name;
      Room room{folder_of(path), {}};
      while (words >> word) {
        if (is_one_of(word, {"SOURCES", "COMMANDS", "NEEDS", "WITH", "FOLDERS"})) list = word;
        else if (list == "NEEDS") room.needs.push_back(word.substr(word.rfind(':') + 1));
      }
      rooms[name] = room;
    }
  }
  return rooms;
}

std::vector<std::string> upward_includes(const Tree& tree) {
  std::vector<std::string> faults;
  const auto rooms = rooms_of(tree);
  for (const auto& [name, room] : rooms) {
    for (const std::string& need : room.needs) {
      if (!rooms.contains(need))
        faults.push_back(room.folder + "/CMakeLists.txt: NEEDS likeness::" + need + ", which is no room");
      else if (foundations(rooms, need).contains(name))
        faults.push_back(room.folder + "/CMakeLists.txt: " + name + " and " + need +
                         " need each other; one must be the lower");
    }
  }
  const std::regex include(R"re(^\s*#\s*include\s+"([^"]+)")re");
  for (const auto& [path, content] : tree) {
    if (!is_cpp(path) || path == "main.cc" || path.starts_with("tests/")) continue;
    const std::string room = room_of(rooms, path);
    if (room.empty()) {
      faults.push_back(path + ": lies in no room: no likeness_library() is declared in its folder or above");
      continue;
    }
    const std::set<std::string> allowed = foundations(rooms, room);
    const auto lines = lines_of(content);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      std::smatch match;
      if (!std::regex_search(lines[i], match, include)) continue;
      const std::string header = match[1], other = room_of(rooms, header);
      if (other.empty()) faults.push_back(place(path, i) + "includes \"" + header + "\", which lies in no room");
      else if (!allowed.contains(other))
        faults.push_back(place(path, i) + "room " + room + " includes \"" + header + "\" of room " + other +
                         ", which is not in its NEEDS: move the thing down, or add the need if it points downwards");
    }
  }
  return faults;
}

std::vector<std::string> misplaced_files(const Tree& tree) {
  std::vector<std::string> faults;
  for (const auto& [path, content] : tree) {
    const std::size_t slash = path.find('/');
    const std::string top = path.substr(0, slash);
    if (slash == std::string::npos
            ? !is_one_of(top, {"CMakeLists.txt", "CMakePresets.json", "likeness.cmake", "likeness-config.cmake.in",
                               "main.cc", "bootstrap", "README.md", "CHANGELOG.md", "LICENSE", ".gitignore",
                               ".clang-format", ".clang-tidy", ".editorconfig"})
            : !is_one_of(top,
                         {"brdf", "fit", "olat", "realis", "render", "tests", "datasets_synthetic", "docs", ".ci"}))
      faults.push_back(path + ": the root holds the rooms and a few files; '" + top + "' is none of them");

    std::istringstream parts(path);
    for (std::string part; std::getline(parts, part, '/');) {
      const std::string stem = part.substr(0, part.find('.', 1));
      std::istringstream words(stem);
      bool empty_word = is_one_of(stem, {"core", "base", "types"});
      for (std::string word; std::getline(words, word, '_');)
        empty_word |= is_one_of(
            word, {"util", "utils", "utility", "utilities", "helper", "helpers", "common", "misc", "manager"});
      if (empty_word) faults.push_back(path + ": '" + part + "' says nothing about what is in it; name the thing");
    }
  }
  return faults;
}

std::vector<std::string> oversized_files(const Tree& tree, int most_lines) {
  std::vector<std::string> faults;
  for (const auto& [path, content] : tree) {
    const auto lines = std::count(content.begin(), content.end(), '\n');
    if (is_source(path) && lines > most_lines)
      faults.push_back(path + ": " + std::to_string(lines) + " lines, at most " + std::to_string(most_lines) +
                       ": split it at its second idea");
  }
  return faults;
}

std::vector<std::string> dead_or_postponed_code(const Tree& tree) {
  struct Rule {
    std::regex pattern;  // written so that this file does not report itself
    std::string why;
  };
  const std::array rules{
      Rule{std::regex(R"(^\s*#\s*if\s+0\b)"), "code that is switched off"},
      Rule{std::regex("DISABLED[_]"), "a test that is switched off"},
      Rule{std::regex(R"(\b(TOD[O]|FIXM[E]|XX[X])\b)"), "postponed work: do it, or write an issue"},
      Rule{std::regex(R"(GTEST_SKIP[(][)]\s*(;|$))"), "a skip without a reason on the same line"},
  };
  std::vector<std::string> faults;
  for (const auto& [path, content] : tree) {
    if (!is_source(path)) continue;
    const auto lines = lines_of(content);
    for (std::size_t i = 0; i < lines.size(); ++i)
      for (const Rule& rule : rules)
        if (std::regex_search(lines[i], rule.pattern)) faults.push_back(place(path, i) + rule.why);
  }
  return faults;
}

std::vector<std::string> machine_paths(const Tree& tree) {
  std::vector<std::string> faults;
  for (const auto& [path, content] : tree) {
    const auto lines = lines_of(content);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      for (const std::string top : {"work", "root", "home"}) {
        const std::string folder = "/" + top + "/";
        const std::size_t at = lines[i].find(folder);
        if (at == std::string::npos) continue;
        const bool starts_a_path =
            at == 0 || std::string_view(" \t\"'=:(`<>,").find(lines[i][at - 1]) != std::string_view::npos;
        if (starts_a_path) faults.push_back(place(path, i) + "a path of one machine: " + folder + "...");
      }
    }
  }
  return faults;
}

std::vector<std::string> unguarded_headers(const Tree& tree) {
  std::vector<std::string> faults;
  for (const auto& [path, content] : tree) {
    const auto lines = lines_of(content);
    if (is_one_of(extension_of(path), {"h", "hpp"}) &&
        std::find(lines.begin(), lines.end(), "#pragma once") == lines.end())
      faults.push_back(path + ": a header without #pragma once");
  }
  return faults;
}

std::vector<std::string> foreign_includes_of_brdf(const Tree& tree) {
  std::vector<std::string> faults;
  const std::regex include(R"(^\s*#\s*include\s+<([^>]+)>)"), allowed("[a-z_]+|glm/.*");
  const auto rooms = rooms_of(tree);
  for (const auto& [path, content] : tree) {
    const std::string room = path.starts_with("brdf/") ? room_of(rooms, path) : "";
    if (!is_cpp(path) || (room != "brdf" && !(room.empty() && path.starts_with("brdf/"))) || path == "brdf/jet.h" ||
        path == "brdf/batch.h")
      continue;
    const auto lines = lines_of(content);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      std::smatch match;
      if (std::regex_search(lines[i], match, include) && !std::regex_match(match[1].str(), allowed))
        faults.push_back(place(path, i) + "<" + match[1].str() + "> is neither the standard library nor GLM");
    }
  }
  return faults;
}

std::vector<std::string> broken_links(const Tree& tree) {
  std::vector<std::string> faults;
  const std::regex link(R"(\]\(([^)#:\s]+)(#[^)]*)?\))");  // [text](path), not [text](https://...)
  for (const auto& [path, content] : tree) {
    if (extension_of(path) != "md") continue;
    const auto lines = lines_of(content);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      for (std::sregex_iterator at(lines[i].begin(), lines[i].end(), link), end; at != end; ++at) {
        const std::string target =
            (std::filesystem::path(folder_of(path)) / (*at)[1].str()).lexically_normal().generic_string();
        const auto found = tree.lower_bound(target);  // the file, or the first file of the folder
        if (found == tree.end() ||
            !(found->first == target || found->first.starts_with(target + (target.ends_with('/') ? "" : "/"))))
          faults.push_back(place(path, i) + "links to " + target + ", which is not there");
      }
    }
  }
  return faults;
}

}  // namespace likeness::house
