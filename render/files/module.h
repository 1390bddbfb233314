#pragma once

// Parts of the program that are loaded when they are first used, because the libraries that they link cost each process
// milliseconds before main. A module is searched for in, and nowhere else:
//   1. the folder in the environment variable LIKENESS_MODULES, if that is set;
//   2. lib/likeness in the program's folder and the three above it: PREFIX/lib/likeness of an installed
//      PREFIX/bin/likeness, or that of the build folder; the module must have the program's owner, or root.
namespace likeness::files {

struct Module {
  const char* file;     // likeness_image_io.so
  const char* purpose;  // "pictures other than EXR"
  const char* library;  // "OpenImageIO"
};

// A function of the module by its name. Loads the module at the first call. Throws std::runtime_error, one line.
void* module_function(const Module& module, const char* name);

}  // namespace likeness::files
