#pragma once

// Ctrl-C, and a request to end, as a question that long work asks itself between two pieces.
namespace likeness::files {

// From now on SIGINT and SIGTERM only make interrupted() true. A second one ends the program at once, which loses
// nothing either: files are whole or absent.
void catch_interrupts();

bool interrupted();

// Thrown by work that stops because interrupted() is true.
struct Interrupted {};

}  // namespace likeness::files
