uniform int lighting;         // 0: a point light, 1: an environment
uniform vec3 lightPosition;   // in the scene
uniform vec3 lightRadiance;   // E·d² of the point light, or the environment's scale
uniform vec3 ambient;         // irradiance from everywhere, by π reflected
uniform bool fallsOff;        // E = P/d², or P
uniform vec2 beam;            // gradient of log P by the tangents of the light's direction
uniform float exposure;
uniform int channel;          // 0: all, then diffuse, specular, roughness, normal, confidence
uniform sampler2D confidenceMap;
uniform vec3 eye;

in vec2 vUv;
in vec3 vPosition, vTangent, vBitangent, vNormal;
out vec4 colour;

uniform samplerCube environmentMap;  // three.js's prefiltered mip levels
uniform float environmentLods;       // the last of them
uniform vec2 environmentTurn;        // cosine and sine of its turn around the sample's vertical

// What the environment, filtered for a lobe of `roughness`, sends from direction d. Its up is y.
vec3 environment(vec3 d, float roughness) {
  vec2 turned = vec2(environmentTurn.x * d.x + environmentTurn.y * d.y,
                     environmentTurn.x * d.y - environmentTurn.y * d.x);
  float sharp = 1.0 - roughness;  // level of a roughness: PMREMGenerator.getRoughness, inverted
  return textureLod(environmentMap, vec3(turned.x, d.z, -turned.y),
                    environmentLods * (1.0 - sharp * sharp)).rgb;
}

// Split sum (Karis, Physically Based Shading on Mobile, 2014): the lobe's share of the filtered
// environment is F0·x + y.
vec2 lobeShare(float roughness, float noV) {
  vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float a = min(r.x * r.x, exp2(-9.28 * noV)) * r.x + r.y;
  return vec2(-1.04, 1.04) * a + r.zw;
}

vec3 environmentInLobe(Texel t, int lobe, vec3 n, vec3 v) {
  float roughness = lobeRoughness(t, lobe);
  vec2 share = lobeShare(roughness, max(dot(n, v), 0.0));
  return (lobeF0(t, lobe) * share.x + share.y) * environment(reflect(-v, n), roughness);
}

vec3 underEnvironment(Texel t, vec3 n, vec3 v) {
  vec3 mirrored = lobeShares.x * environmentInLobe(t, 0, n, v);
  if (lobeShares.y > 0.0) mirrored += lobeShares.y * environmentInLobe(t, 1, n, v);
  return t.diffuse * environment(n, 1.0) + mirrored;
}

vec3 radianceOf(Texel t, vec3 n, vec3 v) {
  if (lighting == 1) return lightRadiance * underEnvironment(t, n, v);
  vec3 toLight = lightPosition - vPosition;
  vec3 l = normalize(toLight);
  vec3 received = fallsOff ? lightRadiance / dot(toLight, toLight) : lightRadiance;
  if (beam != vec2(0.0)) received *= exp(-dot(beam, toLight.xy) / toLight.z);
  vec3 g = normalize(lobeDirection.x * vTangent + lobeDirection.y * vBitangent);
  vec3 reflected = brdf(t, n, l, v, g) * max(dot(n, l), 1e-8);
  vec3 mirrored = lobeShares.x * lobeF0(t, 0) + lobeShares.y * lobeF0(t, 1);
  return received * reflected + ambient * (t.diffuse + mirrored) / 3.14159265358979;
}

void main() {
  Texel t = texelAt(vUv);
  vec3 n = normalize(vTangent * t.normal.x + vBitangent * t.normal.y + vNormal * t.normal.z);
  vec3 v = normalize(eye - vPosition);
  vec3 shown = exposure * radianceOf(t, n, v);
  vec3 display = pow(clamp(shown, 0.0, 1.0), vec3(1.0 / 2.2));
  if (channel == 1) display = pow(clamp(t.diffuse, 0.0, 1.0), vec3(1.0 / 2.2));
  if (channel == 2) display = pow(clamp(t.specular, 0.0, 1.0), vec3(1.0 / 2.2));
  if (channel == 3) display = vec3(t.roughness);
  if (channel == 4) display = 0.5 * t.normal + 0.5;
  if (channel == 5) display = texture(confidenceMap, vUv).rgb;
  colour = vec4(display, 1.0);
}
