// The program's entry: one subcommand does the work.
#include "server/commands/command.h"

int main(int count, char** arguments) { return cyanometer::run_command(count, arguments); }
