in vec3 tangentDirection;
uniform vec2 tiles;
out vec2 vUv;
out vec3 vPosition, vTangent, vBitangent, vNormal;

void main() {
  vUv = uv * tiles;
  vPosition = (modelMatrix * vec4(position, 1.0)).xyz;
  vNormal = normalize(mat3(modelMatrix) * normal);
  vTangent = normalize(mat3(modelMatrix) * tangentDirection);
  vBitangent = cross(vNormal, vTangent);
  gl_Position = projectionMatrix * viewMatrix * vec4(vPosition, 1.0);
}
