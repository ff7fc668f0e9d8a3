# Writes OUT, which defines version(): VERSION, and after a plus sign what the files of the engine and its
# shaders hash to. Whatever is kept under a version, references, frames, tags, is then that of one physics.
file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/engine/*.cpp ${ROOT}/engine/*.h ${ROOT}/engine/*.json
     ${ROOT}/shaders/*)
list(SORT files)
set(hashes "")
foreach(file ${files})
  file(SHA256 ${ROOT}/${file} hash)
  string(APPEND hashes "${file} ${hash}\n")
endforeach()
string(SHA256 build "${hashes}")
string(SUBSTRING ${build} 0 8 build)
file(WRITE ${OUT} "#include \"engine/engine.h\"

std::string cyanometer::version() { return \"${VERSION}+${build}\"; }
")
