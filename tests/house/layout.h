#pragma once

#include <map>
#include <string>
#include <vector>

// The rules of the house, checked on a tree of files held in memory.
namespace likeness::house {

using Tree =
    std::map<std::string,
             std::string>;  // path from the root, with '/', to content; pictures and other binary files have none

struct Room {
  std::string folder;              // "fit/measured"
  std::vector<std::string> needs;  // names of the rooms of its NEEDS list
};

// The rooms by name, from every likeness_library() call in the tree's CMakeLists.txt files.
std::map<std::string, Room> rooms_of(const Tree& tree);

// One line each, "path:line: what is wrong, and the way out"; empty if the house stands.
std::vector<std::string> upward_includes(const Tree& tree);  // a file includes a room that its room does not need
std::vector<std::string> misplaced_files(const Tree& tree);  // unknown folders and root files, names that say nothing
std::vector<std::string> oversized_files(const Tree& tree, int most_lines);
std::vector<std::string> dead_or_postponed_code(const Tree& tree);
std::vector<std::string> machine_paths(const Tree& tree);
std::vector<std::string> unguarded_headers(const Tree& tree);
std::vector<std::string> foreign_includes_of_brdf(
    const Tree& tree);                                    // it needs GLM alone, apart from jet.h and batch.h
std::vector<std::string> broken_links(const Tree& tree);  // of Markdown pages to files of the tree

}  // namespace likeness::house
