<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis styleCategories="Symbology|Symbology3D" version="3.40.0" sync3DRendererTo2DRenderer="1">
  <renderer type="ramp" attribute="HeightAboveGround" min="0" max="20" pointSize="0.8" pointSizeUnit="MM" pointSizeMapUnitScale="3x:0,0,0,0,0,0" maximumScreenError="0.3" maximumScreenErrorUnit="MM" pointSymbol="1" drawOrder2d="1" renderAsTriangles="0" horizontalTriangleFilter="0" horizontalTriangleFilterThreshold="5" horizontalTriangleFilterUnit="MM">
    <colorrampshader colorRampType="INTERPOLATED" classificationMode="1" minimumValue="0" maximumValue="20" clip="0" labelPrecision="3">
      <colorramp type="gradient" name="[source]">
        <Option type="Map">
          <Option type="QString" name="color1" value="74,111,165,255"/>
          <Option type="QString" name="color2" value="181,32,44,255"/>
          <Option type="QString" name="discrete" value="0"/>
          <Option type="QString" name="rampType" value="gradient"/>
          <Option type="QString" name="stops" value="0.25;143,193,169,255;rgb;ccw:0.5;245,230,161,255;rgb;ccw:0.75;238,155,74,255;rgb;ccw"/>
        </Option>
      </colorramp>
      <item value="0" label="0" color="#4a6fa5" alpha="255"/>
      <item value="5" label="5" color="#8fc1a9" alpha="255"/>
      <item value="10" label="10" color="#f5e6a1" alpha="255"/>
      <item value="15" label="15" color="#ee9b4a" alpha="255"/>
      <item value="20" label="20" color="#b5202c" alpha="255"/>
    </colorrampshader>
  </renderer>
  <blendMode>0</blendMode>
</qgis>
