// Slot skip: nothing is known to be empty.
#define SKIPPING 0
