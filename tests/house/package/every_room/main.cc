#include <iostream>

#include "fit/measured/measured.h"
#include "fit/result/result.h"
#include "render/files/files.h"

// Reads a measured material that is not there through the installed libraries: the refusal shows that they link.
int main() {
  const likeness::fit::Options options;
  try {
    likeness::measured::read("no_such.binary");
  } catch (const likeness::files::InputError& error) {
    std::cout << options.model << ": " << error.what() << '\n';
    return 0;
  }
  return 1;
}
