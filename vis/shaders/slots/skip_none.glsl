// Slot skip: no empty-space skipping.
#define SKIPPING 0
