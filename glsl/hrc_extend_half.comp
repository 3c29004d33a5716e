// Longer ray pieces in half floats: see lib/hrc_extend.glsl for what is read and written. One thread is what it says there.
#version 430 core
#define HRC_FORMAT rgba16f
#include "lib/hrc_extend.glsl"
