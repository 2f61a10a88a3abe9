uniform int lighting;         // 0: a point light, 1: a studio
uniform vec3 lightPosition;   // in the scene
uniform vec3 lightRadiance;   // E·d² of the point light, or the studio's scale
uniform vec3 ambient;         // irradiance from everywhere, by π reflected
uniform bool fallsOff;        // E = P/d², or P
uniform float exposure;
uniform int channel;          // 0: all, then diffuse, specular, roughness, normal, confidence
uniform sampler2D confidenceMap;
uniform vec3 eye;

in vec2 vUv;
in vec3 vPosition, vTangent, vBitangent, vNormal;
out vec4 colour;

const int STUDIO_LIGHTS = 24;

// A window to one side, a panel opposite, and dim walls: radiance from direction d.
vec3 studio(vec3 d) {
  float window = smoothstep(0.55, 0.85, dot(d, normalize(vec3(-0.6, 0.5, 0.62))));
  float panel = smoothstep(0.8, 0.95, dot(d, normalize(vec3(0.75, -0.1, 0.65))));
  return vec3(0.18, 0.19, 0.21) + window * vec3(2.6, 2.7, 2.9) + panel * vec3(1.9, 1.7, 1.45);
}

vec3 radianceOf(Texel t, vec3 n, vec3 v) {
  if (lighting == 1) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < STUDIO_LIGHTS; ++i) {  // evenly over the hemisphere, golden angle
      float z = (float(i) + 0.5) / float(STUDIO_LIGHTS);
      float azimuth = 2.39996323 * float(i), r = sqrt(1.0 - z * z);
      vec3 l = vec3(r * cos(azimuth), r * sin(azimuth), z);
      // Each stands for its share of the sky, so it is as wide as that.
      sum += studio(l) * brdf(t, n, l, v, 0.06) * max(dot(n, l), 0.0);
    }
    return lightRadiance * sum * 6.2831853 / float(STUDIO_LIGHTS);
  }
  vec3 toLight = lightPosition - vPosition;
  vec3 l = normalize(toLight);
  vec3 received = fallsOff ? lightRadiance / dot(toLight, toLight) : lightRadiance;
  vec3 reflected = brdf(t, n, l, v, 0.0) * max(dot(n, l), 1e-8);
  return received * reflected + ambient * (t.diffuse + t.specular) / 3.14159265358979;
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
