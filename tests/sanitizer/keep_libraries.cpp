// Linked into every program of a sanitizer's build: what is loaded while it runs stays loaded.
//
// Vulkan's loader unloads a driver with the last instance. What the driver's own globals hold,
// such as 128 bytes that Mesa fills once a process, then counts as leaked, in a program that
// does no more than list the devices too. With the driver there it does not, and whatever
// nothing holds still does: Leaks.OfADevicesObjectsAreFound.

extern "C" int dlclose(void*) { return 0; }
