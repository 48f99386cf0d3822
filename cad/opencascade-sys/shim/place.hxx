// Where a reading child stands, told on standard error should OCCT crash or hang: OCCT does not check all that it reads.
#pragma once
#include "rust/cxx.h"
#include <fstream>

namespace occt {

// From here on a crash of this process is told of, with the place; so is SIGXCPU, with which a parent asks before it ends a hanging child.
// For a process that does nothing but read a file.
void tell_crashes();

// The place: an entity.
void stand_at(rust::Str entity);

// The place: where a text stands; no longer once this goes out of scope.
class Standing {
public:
  Standing(std::filebuf* text, const char* path);
  ~Standing();
};

} // namespace occt
