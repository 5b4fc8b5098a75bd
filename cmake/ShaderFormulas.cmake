# tessera_shader_formulas(<text> <result>): formulas that are C++ templates over the number N (volume/base/numbers.h) as
# GLSL. They keep to what both languages have: functions, structs without constructors, locals, loops, `?:` by choose().
# Values are made as N(1) or glm::vec<3, N>(x, y, z); locals are initialised by `=`, one in a declaration.
function(tessera_shader_formulas text result)
  # What C++ says beside the formulas.
  foreach(line IN ITEMS "#pragma once" "#include [^\n]*" "namespace [^\n]*{" "} // namespace[^\n]*" "template <class N> ?")
    string(REGEX REPLACE "${line}\n?" "" text "${text}")
  endforeach()
  string(REPLACE "inline constexpr double" "const float" text "${text}")
  string(REPLACE "inline constexpr" "const" text "${text}")
  # Types.
  string(REGEX REPLACE "glm::vec<([234]), N>" "vec\\1" text "${text}")
  string(REGEX REPLACE "glm::dvec([234])" "vec\\1" text "${text}")
  string(REPLACE "<N>" "" text "${text}")
  string(REGEX REPLACE "const ([A-Za-z0-9]+)& " "\\1 " text "${text}")
  string(REGEX REPLACE "(\n +)const " "\\1" text "${text}")
  # Words: all of numbers.h that GLSL names otherwise. Twice, as neighbours share what is between them.
  set(words N float double float smaller min larger max clamped clamp blended mix smoothStep smoothstep magnitude abs
      squareRoot sqrt roundDown floor roundUp ceil inner dot lengthOf length unit normalize crossProduct cross sine sin
      cosine cos powerOfTwo exp2 logarithm log2)
  while(words)
    list(POP_FRONT words ours theirs)
    foreach(time IN ITEMS first second)
      string(REGEX REPLACE "(^|[^A-Za-z0-9_])${ours}([^A-Za-z0-9_])" "\\1${theirs}\\2" text "${text}")
    endforeach()
  endwhile()
  set(${result} "#include \"lib/shading/choose.glsl\"\n${text}" PARENT_SCOPE)
endfunction()
