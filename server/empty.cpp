namespace cyanometer{}
